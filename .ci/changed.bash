# What a change asks of continuous integration, by the paths that it touches.

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
  [classic_session]='^protocol/classic/'
  [config]='^cli/arguments/'
  [encodings]='^(protocol/encoding|system)/'
  [game_file]='^games/(files|language|game)/'
  [image]='^(games/(rom_image|zip_archive)|emulator/cartridge/)'
  [line_session]='^protocol/line/'
  [media]='^recording/'
  [plan]='^agents/(experiment|kinds)/'
  [rl_glue]='^protocol/classic/rl_glue'
  [state]='^(environment/saved|emulator/state)/'
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
