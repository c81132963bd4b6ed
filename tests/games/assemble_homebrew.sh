#!/bin/sh
# assemble_homebrew.sh FOLDER NAME: tests that FOLDER/NAME.asm assembles to exactly FOLDER/NAME.bin. Status 77: dasm is missing.
set -eu
folder=$1
name=$2

if ! command -v dasm >/dev/null; then
  echo "SKIP: dasm is not installed; $name.bin was not compared with $name.asm"
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
