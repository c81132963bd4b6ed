# What a change asks of continuous integration, by the paths that it touches.
# shellcheck disable=SC2034  # .ci/run uses the tables

# The last landed commit: RACEBEAM_LANDED, or where HEAD left origin/main. Empty if it is not known.
landed() {
  git rev-parse --verify --quiet "${RACEBEAM_LANDED:-$(git merge-base HEAD origin/main 2>/dev/null)}^{commit}" || true
}

# The files that the commits after it change, but do not delete.
changed_files() { [[ -z $1 ]] || git diff --name-only --diff-filter=d "$1" HEAD --; }

# The paths that a step is for: the more of them a change touches, the rather its step is run.
declare -A step_paths=(
  [clang]='^(emulator|games|system|library|include)/'
  [address]='^(recording|environment/saved|protocol/(line|classic|encoding))/'
  [thread]='^(server|environment/vector|protocol/running|agents)/'
  [fuzz]='^(fuzz|games/(files|language)|cli/arguments)/|^games/(rom_image|zip_archive)'
)
readonly step_names=(clang address thread fuzz)

# A target of fuzz/, and the paths that it reads the inputs of.
declare -A fuzz_paths=(
  [access]='^server/(access|web/origin)'
  [announce]='^(server/operation/(announcement|published_file)|clients/cpp/racebeam/client/address)'
  [background_csv]='^agents/features/background'
  [checkpoint]='^(agents/(base|experiment/trial|learning|planning)|recording/sealed_file)'
  [classic_session]='^protocol/classic/'
  [config]='^cli/arguments/'
  [encodings]='^(protocol/encoding|system)/'
  [episode_log]='^(agents/experiment/play|recording/(episode_log|sealed_file))'
  [game_file]='^games/(files|language|game)/'
  [http]='^server/web/(exchange|http|origin|page_files|site)'
  [image]='^(games/(rom_image|zip_archive)|emulator/cartridge/)'
  [line_session]='^protocol/line/'
  [media]='^recording/(avi|film_encoder|gif|lzw|media|png|wav|y4m)'
  [plan]='^agents/(experiment|kinds)/'
  [rl_glue]='^protocol/classic/rl_glue'
  [state]='^(environment/saved|emulator/state)/'
  [submission]='^(agents/experiment/(results|row_tally|log_judge|phrase_seeds|verify)|recording/(phrase_seed|result_row))'
  [tls]='^server/(access/tls|web/byte_stream)'
  [web_socket]='^server/web/(byte_stream|replies|web_socket)'
)
readonly fuzz_targets=(fuzz/corpora/*)

# most_touched TABLE FALLBACK: the key of the table whose paths most of the lines of the input match; FALLBACK if none
# does. Of keys with the same number, the first in order of the alphabet.
most_touched() {
  local -n table=$1
  local best=$2 most=0 key count files
  files=$(cat)
  for key in $(printf '%s\n' "${!table[@]}" | sort); do
    count=$(grep -cE "${table[$key]}" <<<"$files" || true)
    ((count > most)) && most=$count best=$key
  done
  echo "$best"
}
