# A client of the racebeam line protocol for bash 5, to be sourced. It needs bash and the programs of a base system; for zlib
# also gzip.
# shellcheck disable=SC2034,SC2004  # programs read the variables; keys of associative arrays
#
#   source racebeam.bash
#   racebeam_connect tcp://127.0.0.1:7800
#   racebeam_ask load beamfall seed=7
#   racebeam_ask act FIRE && racebeam_value reward
#
# A function returns 0, or one of these, with a sentence in $racebeam_error:
#   1  the server refused the request; the code is in $racebeam_code; the session continues
#   2  the server is not there, has gone, or sent an invalid reply; the session has ended
#   3  the server did not answer within $racebeam_timeout seconds; the session has ended
#   4  the caller's words are not accepted
# One session at a time; a subshell can have another.
#
# A value is a text that the server chooses, and bash executes parts of a text in arithmetic: a[$(COMMAND)]. Use racebeam_number
# there.

racebeam_timeout=60 racebeam_longest=268435456
racebeam_input='' racebeam_output='' racebeam_error='' racebeam_code=''
racebeam_reply='' racebeam_request=''  # of the reply: its line without `ok`, and the request
racebeam_sent=()                       # requests without a reply
racebeam_height=0
declare -A racebeam_encodings=() racebeam_arrays=()  # of fields; of `MACHINE FIELD`: what deltas have made, as digits
declare -A racebeam_watched=()         # of `@NAME`: the height of the screen, and the fields

# generated: fields, from protocol/protocol.toml
# The encodings of fields of bytes where a request does not name one.
declare -rA racebeam_usual=(
  [ram]=hex
  [tia]=hex
  [state_hash]=hex
  [screen]=rle
  [rgb]=zlib
  [grey]=zlib
  [palette]=hex
  [audio]=hex
  [audio_all]=hex
)
# The sizes in bytes of fields whose size never changes; bytes per pixel of those with the screen's size.
declare -rA _racebeam_sizes=(
  [ram]=128
  [tia]=53
  [state_hash]=8
  [palette]=768
  [audio]=512
)
declare -rA _racebeam_pixels=(
  [screen]=1
  [rgb]=3
  [grey]=1
)
# end of fields

_racebeam_fail() { racebeam_error=$2; return "$1"; }

_racebeam_lost() { racebeam_close; _racebeam_fail "$@"; }

# racebeam_connect [ADDRESS [TOKEN]]: opens a session at tcp://HOST:PORT, pipes:PREFIX, stdio or file:PATH; without an address, at
# that of RACEBEAM_ADDRESS. file:PATH is the first address in the server's ready file or announce file. An announce file has a
# token as well. file:PATH?wait=SECONDS waits for the file, and for the server in it.
racebeam_connect() {
  local address=${1:-${RACEBEAM_ADDRESS-}} until=$SECONDS status
  if [[ $address =~ ^(file:.+)\?wait=([0-9]{1,9})(\.[0-9]+)?$ ]]; then
    address=${BASH_REMATCH[1]} until=$((SECONDS + 10#${BASH_REMATCH[2]} + (${#BASH_REMATCH[3]} > 0)))
  elif [[ $address == file:?*\?wait=* ]]; then
    _racebeam_fail 4 "the address is '$address'; ?wait= takes seconds, from 0 to 999999999"
    return
  fi
  until _racebeam_try "$address" "${2-}"; do
    status=$?
    ((status == 2 && SECONDS < until)) || return $status
    sleep 0.1
  done
}

readonly _racebeam_files='file:PATH takes the --ready-file or --announce file of a server'

# Sets `address` and `token` to those of the file PATH.
_racebeam_in_file() {
  local text version known=''
  if [[ -e $1 && ! -f $1 ]]; then  # a pipe might block
    _racebeam_fail 4 "$1 is not a regular file; $_racebeam_files"
    return
  fi
  text=$(cat -- "$1" 2>/dev/null | tr -d '\0'; exit "${PIPESTATUS[0]}") || { _racebeam_fail 2 "$1 cannot be read"; return; }
  [[ $text == ['{#']* ]] && known=yes
  if [[ $text == '{'* ]]; then
    version=$(sed -n '1s/^{"racebeam_announce": \([0-9]*\).*/\1/p' <<<"$text")
    token=${token:-$(sed -n 's/^ "token": "\([^"]*\)"}$/\1/p' <<<"$text")}
    if [[ -n $version && $version != 1 ]]; then
      _racebeam_fail 4 "$1 is an announce file of version $version; this client reads version 1"
      return
    elif [[ -z $version || $text != *'"}' ]]; then
      _racebeam_fail 4 "$1 is not a whole announce file"
      return
    fi
    text=$(sed -n 's/^  "\(.*\)",\{0,1\}$/\1/p' <<<"$text")
  fi
  address=$(grep -a -m 1 -E '^(tcp|pipes):' <<<"$text") && return
  if [[ $known ]]; then
    _racebeam_fail 4 "$1 names no address for bash"
  elif [[ $text ]]; then
    _racebeam_fail 4 "$1 has other contents; $_racebeam_files"
  else
    _racebeam_fail 4 "$1 is empty; $_racebeam_files"
  fi
}

_racebeam_try() {
  local address=$1 token=$2 line source=''
  racebeam_close
  if [[ $address == file:* ]]; then
    _racebeam_in_file "${address#file:}" || return
    source=", which ${1#file:} names"
  fi
  trap '' PIPE  # a server that has gone must not end this process
  if [[ $address =~ ^tcp://\[?([^]]+)\]?:([0-9]+)$ ]]; then
    { exec {racebeam_input}<>"/dev/tcp/${BASH_REMATCH[1]}/${BASH_REMATCH[2]}"; } 2>/dev/null || {
      racebeam_input=''
      _racebeam_fail 2 "no server answers at $address$source"
      return
    }
    exec {racebeam_output}>&"$racebeam_input"
  elif [[ $address == pipes:?* ]]; then
    { exec {racebeam_input}<"${address#pipes:}_out" {racebeam_output}>"${address#pipes:}_in"; } 2>/dev/null || {  # in this order
      racebeam_input=''
      _racebeam_fail 2 "no server answers at $address$source"
      return
    }
  elif [[ $address == stdio ]]; then
    exec {racebeam_input}<&0 {racebeam_output}>&1
  else
    [[ -n $address ]] && source="the address is '$address'" || source='no address was given, and RACEBEAM_ADDRESS is not set'
    _racebeam_fail 4 "$source; it takes tcp://HOST:PORT, pipes:PREFIX, stdio or file:PATH"
    return
  fi
  line=hello${token:+ token=$token}
  racebeam_ask "$line" || { local status=$? error=$racebeam_error; racebeam_close; _racebeam_fail "$status" "$error"; return; }
  [[ $(racebeam_value protocol) == 1 ]] || _racebeam_lost 2 "$address speaks another version of the protocol"
}

# racebeam_launch [PROGRAM]: opens a session with a server that it starts, and that ends with it.
racebeam_launch() {
  local program=${1:-${RACEBEAM_PROGRAM:-racebeam}}
  racebeam_close
  type -P -- "$program" >/dev/null || { _racebeam_fail 2 "there is no program $program"; return; }
  coproc RACEBEAM_SERVER { exec "$program" serve --stdio --log-level warning; }
  exec {racebeam_input}<&"${RACEBEAM_SERVER[0]}" {racebeam_output}>&"${RACEBEAM_SERVER[1]}"
  # shellcheck disable=SC1083  # names of descriptors
  exec {RACEBEAM_SERVER[0]}<&- {RACEBEAM_SERVER[1]}>&-
}

# Ends the session. Further calls do nothing.
racebeam_close() {
  if [[ -n $racebeam_input ]]; then
    exec {racebeam_input}<&- {racebeam_output}>&-
  fi
  racebeam_input='' racebeam_output='' racebeam_sent=() racebeam_encodings=() racebeam_arrays=() racebeam_watched=()
}

# racebeam_send WORD...: sends a request. Send at most a few dozen ahead: a server that cannot send its replies stops reading.
racebeam_send() {
  local line="$*"
  if [[ $line == *$'\n'* || $line =~ ^\ *# ]]; then
    _racebeam_fail 4 "a request is one line, and no comment: '$line'"
  elif [[ -z $racebeam_output ]]; then
    _racebeam_fail 2 'the session has ended'
  else
    racebeam_sent+=("$line")
    printf '%s\n' "$line" 2>/dev/null 1>&"$racebeam_output" || true  # the server may have said why it ends: receive reads that
  fi
}

# Reads the next reply.
racebeam_receive() {
  local line status=0 LC_ALL=C
  if [[ -z $racebeam_input ]]; then
    _racebeam_fail 2 'the session has ended'
    return
  fi
  IFS= read -r -n $((racebeam_longest + 1)) -t "$racebeam_timeout" -u "$racebeam_input" line 2>/dev/null || status=$?
  racebeam_request=${racebeam_sent[0]-}
  racebeam_sent=("${racebeam_sent[@]:1}")
  if ((status > 128)); then
    _racebeam_lost 3 "the server did not answer within $racebeam_timeout seconds"
  elif ((status)) || ((${#line} > racebeam_longest)); then
    _racebeam_lost 2 'the server has closed the connection, or sent an endless line'
  elif [[ $line == error\ ?* ]]; then
    line=${line#error }
    racebeam_code=${line%% *}
    _racebeam_fail 1 "$line"
  elif [[ $line != ok && $line != ok\ * ]]; then
    line=${line:0:60}
    _racebeam_lost 2 "the server sent an invalid reply: '${line//[^ -~]/?}'"  # a terminal would execute some of its bytes
  else
    racebeam_reply=${line#ok}
    _racebeam_follow
  fi
}

# racebeam_ask WORD...: a request and its reply.
racebeam_ask() { racebeam_send "$@" && racebeam_receive; }

# racebeam_value KEY: prints a value of the reply's first group.
racebeam_value() {
  local rest="$racebeam_reply "
  [[ $rest == *" $1="* ]] || return 1
  rest=${rest#*" $1="}
  printf '%s\n' "${rest%% *}"
}

# racebeam_number KEY: prints a value of the reply's first group that is a whole number. Prints nothing, and returns 1, if it is
# another text.
racebeam_number() {
  local text
  text=$(racebeam_value "$1") && [[ $text =~ ^-?[0-9]{1,18}$ ]] && printf '%s\n' "$text"
}

# racebeam_save_png PATH [MACHINE]: saves a picture of the screen as a PNG file.
racebeam_save_png() {
  racebeam_ask shot ${2:+"machine=$2"} || return
  { racebeam_value data | base64 -d >"$1"; } 2>/dev/null || _racebeam_fail 4 "the picture cannot be written to $1"
}

# Remembers what a request that was granted changes about later replies.
_racebeam_follow() {
  local seen word
  local -a words
  read -ra words <<<"$racebeam_request"
  case ${words[0]-} in
    load)
      racebeam_height=$(racebeam_number height) || { _racebeam_lost 2 'the reply of load has no height'; return; }
      _racebeam_forget '[0-9]* *' ;;
    observe) if ((${#words[@]} > 1)); then _racebeam_choose racebeam_encodings "${words[@]:1}"; _racebeam_forget '[0-9]* *'; fi ;;
    open) _racebeam_forget '[1-9]* *' ;;
    watch)
      seen=$(racebeam_number height || echo "$racebeam_height")
      for word in "${words[@]:2}"; do [[ $word == *=* ]] || seen+=" $word"; done
      [[ ${racebeam_watched["@${words[1]}"]-} == "$seen" ]] || _racebeam_forget "@${words[1]} *"
      racebeam_watched["@${words[1]}"]=$seen ;;
  esac
}

# Forgets the arrays whose keys match a pattern.
_racebeam_forget() {
  local key
  for key in "${!racebeam_arrays[@]}"; do
    # shellcheck disable=SC2053
    if [[ $key == $1 ]]; then unset 'racebeam_arrays[$key]'; fi  # unset expands the key
  done
}

# racebeam_chosen NAME: puts the encodings of the reply's fields into the associative array NAME: those of the fields that the
# request names, or else of those that `observe` chose.
racebeam_chosen() {
  local -n chosen_here=$1
  local -a words
  local field
  read -ra words <<<"$racebeam_request"
  chosen_here=()
  if [[ ${words[0]-} == watch ]]; then
    _racebeam_choose "$1" "${words[@]:2}"
  elif [[ ${words[0]-} == look ]] && ((${#words[@]} > 1)); then
    _racebeam_choose "$1" "${words[@]:1}"
  else
    for field in "${!racebeam_encodings[@]}"; do chosen_here[$field]=${racebeam_encodings[$field]}; done
  fi
}

# The encodings of fields such as `screen:delta`, into the array that is named.
_racebeam_choose() {
  local -n chosen=$1
  local field name
  chosen=()
  for field in "${@:2}"; do
    name=${field%%:*}
    if [[ $field == *:* ]]; then
      chosen[$name]=${field#*:}
    elif [[ $name =~ ^(grey|rgb)[0-9] ]]; then
      chosen[$name]=zlib
    elif [[ -n ${racebeam_usual[$name]-} ]]; then
      chosen[$name]=${racebeam_usual[$name]}
    fi
  done
}

# Prints the size of a field in bytes, where screens have as many rows.
_racebeam_size() {
  local field=$1 height=$2 pixel=${_racebeam_pixels[$1]-}
  if [[ $field =~ ^grey84(x([0-9]+))?$ ]]; then
    echo $((84 * 84 * ${BASH_REMATCH[2]:-1}))
  elif [[ $field =~ ^(grey|rgb)([0-9]+)x([0-9]+)x([0-9]+)$ ]]; then
    echo $((BASH_REMATCH[2] * BASH_REMATCH[3] * BASH_REMATCH[4] * (${#BASH_REMATCH[1]} == 3 ? 3 : 1)))
  else
    echo "${_racebeam_sizes[$field]:-$((height * 160 * pixel))}"
  fi
}

# racebeam_bytes MACHINE FIELD ENCODING TEXT: puts the bytes of a field, as hexadecimal digits, into $racebeam_digits. Machine 0 is
# that of load, and @NAME a session that is watched. Each delta must be given once, in the order of the replies.
racebeam_bytes() {
  local key="$1 ${2#final_}" size height=$racebeam_height
  case $3 in
    hex) racebeam_digits=$4; [[ $4 != *[!0-9A-F]* ]] && ((${#4} % 2 == 0)) ;;
    rle) racebeam_digits=$(_racebeam_runs <<<"$4") ;;
    base64) racebeam_digits=$(_racebeam_octets < <(base64 -d <<<"$4")) ;;
    zlib) racebeam_digits=$(_racebeam_inflate "$4") ;;
    delta)
      if [[ -z ${racebeam_arrays[$key]+is} ]]; then
        [[ $1 != @* ]] || height=${racebeam_watched[$1]%% *}
        size=$(_racebeam_size "${2#final_}" "$height")
        printf -v 'racebeam_arrays[$key]' '%0*d' $((2 * size)) 0
      fi
      racebeam_digits=$(_racebeam_change <<<"${racebeam_arrays[$key]} $4") && racebeam_arrays[$key]=$racebeam_digits ;;
  esac || _racebeam_lost 2 "the field $2 is damaged"
}

_racebeam_octets() { od -An -v -tx1 | tr -d ' \n' | tr a-f A-F; }

# Functions of awk: the value of two digits, and two digits written N times.
readonly _racebeam_awk='
  BEGIN { for (i = 0; i < 256; ++i) value[sprintf("%02X", i)] = i }
  function octet(text, at) { if (!(substr(text, at, 2) in value)) exit bad = 1; return value[substr(text, at, 2)] }
  function times(digits, count,  text) { text = digits; while (length(text) < 2 * count) text = text text; return substr(text, 1, 2 * count) }
  END { if (bad) exit 1 }'

_racebeam_runs() {
  awk "$_racebeam_awk"'{ for (at = 1; at <= length($0); at += 4) printf "%s", times(substr($0, at, 2), octet($0, at + 2)) }'
}

_racebeam_change() {
  awk "$_racebeam_awk"'{
    place = 1
    for (at = 1; at <= length($2); ) {
      skip = 2 * (256 * octet($2, at) + octet($2, at + 2)); runs = octet($2, at + 4)
      printf "%s", substr($1, place, skip)
      place += skip; at += 6
      for (; runs > 0; --runs) {
        count = octet($2, at + 2); printf "%s", times(substr($2, at, 2), count)
        place += 2 * count; at += 4
      }
    }
    if (place > length($1) + 1) exit bad = 1
    printf "%s", substr($1, place)
  }'
}

# gzip has the same streams as zlib, with another head and another sum at the end. The sum is checked here.
_racebeam_inflate() {
  local digits sum
  digits=$({ printf '\x1f\x8b\x08\0\0\0\0\0\0\0'; base64 -d <<<"$1" | tail -c +3; } 2>/dev/null | gzip -dc 2>/dev/null | _racebeam_octets)
  sum=$(base64 -d 2>/dev/null <<<"$1" | tail -c 4 | od -An -v -tx1 | tr -d ' \n')
  [[ $(racebeam_sum <<<"$digits") == "$sum" ]] && echo "$digits"
}

# The Adler-32 (RFC 1950) of the digits on standard input.
racebeam_sum() {
  awk "$_racebeam_awk"'{
    a = 1; b = 0
    for (at = 1; at < length($0); at += 2) { a = (a + octet($0, at)) % 65521; b = (b + a) % 65521 }
    printf "%04x%04x\n", b, a
  }'
}
