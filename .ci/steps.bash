# Steps of continuous integration, for .ci/run and .ci/nightly. A step is run to its end, timed and counted; those after
# it are run whatever it gave.

passed=0 failed=0 skipped=0 steps=0
broken=() left_out=() times=()
log=$(mktemp) failures=$(mktemp)
trap 'rm -f "$log" "$failures"' EXIT

# run NAME COMMAND...: adds what its last line counts, and keeps its time. Status 77: something is not to be had here.
run() {
  local name=$1 status=0 began=$SECONDS last
  shift
  echo "ci: $name: $*"
  "$@" 2>&1 | tee "$log" || status=$?
  steps=$((steps + 1)) times+=("$((SECONDS - began)) $name")
  last=$(tail -n 1 "$log")
  if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed,\ ([0-9]+)\ (skipped|left\ something\ out)$ ]]; then
    passed=$((passed + BASH_REMATCH[1])) failed=$((failed + BASH_REMATCH[2])) skipped=$((skipped + BASH_REMATCH[3]))
  fi
  if ((status == 77)); then
    left_out+=("$name")
  elif ((status != 0)); then
    broken+=("$name")
    { echo "ci: the end of $name:"; tail -n 60 "$log"; } >>"$failures"
  fi
}

# The times of all steps, the ends of those that failed, and two lines that count. Its status is that of the whole.
finish() {
  local line
  cat "$failures"
  for line in "${times[@]}"; do printf 'ci: %6d s  %s\n' "${line%% *}" "${line#* }"; done
  ((${#left_out[@]} == 0)) || echo "ci: left out: ${left_out[*]}"
  ((${#broken[@]} == 0)) || echo "ci: failed: ${broken[*]}"
  echo "ci: $steps steps in $SECONDS s: $((steps - ${#broken[@]} - ${#left_out[@]})) passed, ${#broken[@]} failed, ${#left_out[@]} left out"
  echo "$passed passed, $failed failed, $skipped skipped"
  ((${#broken[@]} == 0))
}
