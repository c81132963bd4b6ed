# The compiler for macOS and musl, and what inspects its products, for platforms/setup. The working folder is the
# checkout.

# Puts Zig into build/platforms/zig, with programs of the names that CMake expects.
zig() {
  local folder=$PWD/build/platforms/zig name
  [[ ! -x $folder/ranlib ]] || return 0
  python3 -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --upgrade --target "$folder/package" \
    ziglang==0.15.2 >&2
  for name in cc c++ ar ranlib; do
    printf '#!/bin/sh\nexec %q %s "$@"\n' "$folder/package/ziglang/zig" "$name" >"$folder/$name"
    chmod +x "$folder/$name"
  done
}

# What inspects programs and modules of macOS, and modules for musl.
inspector() {
  local folder=$PWD/build/platforms/inspector
  [[ ! -x $folder/bin/abi3audit ]] || return 0
  python3 -m venv "$folder"
  "$folder/bin/python" -m pip install --quiet --disable-pip-version-check lief==1.0.0 abi3audit==0.0.26 >&2
}
