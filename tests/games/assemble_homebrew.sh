#!/bin/sh
# assemble_homebrew.sh FOLDER NAME: does FOLDER/NAME.asm assemble to exactly FOLDER/NAME.bin? 77: no dasm to ask.
set -eu
folder=$1
name=$2

if ! command -v dasm >/dev/null; then
  echo "SKIP: dasm is not installed, so whether $name.bin is what $name.asm assembles to was not checked"
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$folder"
if ! dasm "$name.asm" -f3 "-o$work/$name.bin" >"$work/log"; then
  cat "$work/log"
  exit 1
fi
cmp "$work/$name.bin" "$name.bin"
echo "$name.asm assembles to exactly $name.bin"
