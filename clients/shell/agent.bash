#!/usr/bin/env bash
# Plays an episode of Beamfall over TCP, in a dozen lines of bash without other programs: agent.bash HOST PORT.
set -euo pipefail
exec {server}<>"/dev/tcp/${1:?agent.bash HOST PORT}/${2:?agent.bash HOST PORT}"
ask() { echo "$*" >&"$server"; read -r -u "$server" reply; [[ $reply == ok* ]] || { echo "$reply" >&2; exit 1; }; }
number() { [[ "$reply " =~ \ $1=(-?[0-9]+)\  ]] && echo "${BASH_REMATCH[1]}"; }  # bash would execute parts of another text
ask load beamfall seed=1 sticky=0 frame_skip=4
ask observe reward terminated truncated
score=0
until [[ $reply == *terminated=1* || $reply == *truncated=1* ]]; do
  ask act 'RIGHTFIRE*4' 'LEFTFIRE*4'
  score=$((score + $(number reward)))
done
echo "score $score"
