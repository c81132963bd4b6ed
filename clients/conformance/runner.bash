#!/usr/bin/env bash
# Takes the steps of a file with the client in bash, and prints what came of each: runner.bash FILE.
set -u
# shellcheck source=../shell/racebeam.bash
source racebeam.bash
racebeam_longest=1048576

stack_field='' stack_depth=0 stack=()

# Prints the word for the failure STATUS.
failed() {
  case $1 in
    1) echo "error $racebeam_code" ;; 2) echo lost ;; 3) echo timeout ;; 4) echo invalid ;;
  esac
}

# The client's stack of screens, as digits, with $racebeam_digits on top.
push() {
  stack=("${stack[@]}" "$racebeam_digits")
  if ((${#stack[@]} > stack_depth)); then stack=("${stack[@]:1}"); fi
  local missing=$((stack_depth - ${#stack[@]})) zeros=''
  if ((missing)); then printf -v zeros '%0*d' $((missing * ${#racebeam_digits})) 0; fi
  local IFS=
  racebeam_digits="$zeros${stack[*]}"
}

# Prints the reply.
show() {
  local command=${racebeam_request%% *} machine=0 source word key text groups=('')
  local -A encodings
  racebeam_chosen encodings
  if [[ $command =~ ^(reset|load|observe)$ ]]; then stack=(); fi
  for word in $racebeam_reply; do
    if [[ $word == '|' ]]; then
      machine=$((machine + 1)) groups+=('')
      continue
    fi
    [[ $word == *=* ]] || continue
    key=${word%%=*} text=${word#*=}
    if [[ -n ${encodings[${key#final_}]-} ]]; then
      source=$machine
      if [[ $command == watch ]]; then
        source=${racebeam_request#* }
        source=@${source%% *}
      elif [[ $racebeam_request =~ ^restore\ .*\ machine=([0-9]+)$ ]]; then
        source=$((BASH_REMATCH[1] + 1))
      fi
      racebeam_bytes "$source" "$key" "${encodings[${key#final_}]}" "$text" || return
      if [[ $key == "$stack_field" ]]; then push; key+=x$stack_depth; fi
      text=$((${#racebeam_digits} / 2)):$(racebeam_sum <<<"$racebeam_digits")
    fi
    groups[machine]+=$key=$text$'\n'
  done
  text=ok
  for ((machine = 0; machine < ${#groups[@]}; ++machine)); do
    ((machine == 0)) || text+=' |'
    [[ -z ${groups[machine]} ]] || text+=$(printf '%s' "${groups[machine]}" | sort -t= -k1,1 | sed 's/^/ /' | tr -d '\n')
  done
  echo "$text"
}

reply() { racebeam_receive && show || failed $?; }

step() {
  local word=$1
  shift
  case $word in
    section) racebeam_timeout=60 stack_field=''; echo "section $1" ;;
    connect) racebeam_connect "$@" && echo connected || failed $? ;;
    another) (racebeam_input=''; racebeam_connect "$@" && echo connected || failed $?) ;;
    connections) (racebeam_input=''; for ((n = 0; n < $1; ++n)); do racebeam_connect "$2" || failed $?; done; echo connected) ;;
    launch) racebeam_launch "$RACEBEAM_BINARY" && echo connected ;;
    '>') racebeam_send "$*" && reply || { local status=$?; ((status == 0)) || failed $status; } ;;
    send) racebeam_send "$*" || failed $? ;;
    receive) for ((n = 0; n < $1; ++n)); do reply; done ;;
    picture)
      if racebeam_save_png "$1"; then
        local digits
        digits=$(_racebeam_octets <"$1")
        echo "picture $((${#digits} / 2)):$(racebeam_sum <<<"$digits")"
      else
        failed $?
      fi ;;
    keep) printf -v "$1" '%s' "$(racebeam_value "$2")" ;;
    close) racebeam_close ;;
    timeout) racebeam_timeout=$1 ;;
    stack) stack_field=$1 stack_depth=$2 stack=() ;;
    wait) sleep "$1" ;;
    time)
      local steps=$1 ahead=$2 start=$EPOCHREALTIME n at
      shift 2
      for ((n = 0; n < steps; n += ahead)); do
        for ((at = 0; at < ahead; ++at)); do racebeam_send "$*"; done
        for ((at = 0; at < ahead; ++at)); do racebeam_receive; done
      done
      local microseconds=$((${EPOCHREALTIME/./} - ${start/./}))
      printf 'time %d %d.%06d\n' "$ahead" $((microseconds / 1000000)) $((microseconds % 1000000)) ;;
  esac
}

set -f
exec {steps}<"$1"
while IFS= read -r -u "$steps" line; do
  [[ -n ${line// } && $line != \#* ]] || continue
  filled=''
  while [[ $line =~ ^([^\$]*)\$([A-Za-z_]+)(.*)$ ]]; do
    filled+=${BASH_REMATCH[1]}${!BASH_REMATCH[2]} line=${BASH_REMATCH[3]}
  done
  # shellcheck disable=SC2086  # words: `set -f` is in effect
  step $filled$line
done
racebeam_close
