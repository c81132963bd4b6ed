# Libraries that platforms/setup compiles from sources of Debian. Each function does nothing if its library is there. The
# working folder is the checkout.

# Compiles zlib for a platform: FOLDER COMPILER-AND-OPTIONS... ARCHIVER.
zlib() {
  local folder=$PWD/build/platforms/sources/zlib into=$PWD/build/platforms/$1 compile=("${@:2:$#-2}") archive=${*: -1} object
  [[ ! -f $into/lib/libz.a ]] || return 0
  source_of zlib
  object=$(mktemp -d)
  mkdir -p "$into"/{include,lib}
  cp "$folder"/{zlib,zconf}.h "$into/include"
  (cd "$object" && for source in "$folder"/*.c; do "${compile[@]}" -O3 -DHAVE_UNISTD_H -c "$source"; done &&
    "$archive" rcs "$into/lib/libz.a" ./*.o)
  rm -r "$object"
}

# Compiles libpng for a platform: FOLDER COMPILER-AND-OPTIONS... ARCHIVER.
libpng() {
  local source=$PWD/build/platforms/sources/libpng1.6 to=$PWD/build/platforms/$1 compile=("${@:2:$#-2}") archive=${*: -1} object
  [[ ! -f $to/lib/libpng.a ]] || return 0
  source_of libpng1.6
  object=$(mktemp -d)
  mkdir -p "$to"/{include,lib}
  cp "$source/scripts/pnglibconf.h.prebuilt" "$to/include/pnglibconf.h"
  cp "$source"/{png,pngconf}.h "$to/include"
  (cd "$object" && for file in "$source"/png*.c; do
    [[ $file == */pngtest.c ]] || "${compile[@]}" -O2 "-I$to/include" -c "$file"
  done && "$archive" rcs "$to/lib/libpng.a" ./*.o)
  rm -r "$object"
}

# Compiles OpenSSL for a platform: FOLDER TARGET-OF-OPENSSL OPTION...
openssl() {
  local source=$PWD/build/platforms/sources/openssl to=$PWD/build/platforms/$1 object
  [[ ! -f $to/lib/libssl.a ]] || return 0
  source_of openssl
  object=$(mktemp -d)
  mkdir -p "$to"/{include,lib}
  (cd "$object" && "$source/Configure" "${@:2}" --prefix="$to" --libdir=lib no-shared no-tests no-engine no-module no-legacy no-dtls \
    no-comp no-ui-console no-autoload-config && make -j"$(nproc)" build_libs) >"$to/openssl.log" 2>&1 || {
    tail -20 "$to/openssl.log" >&2
    return 1
  }
  cp -r {"$source","$object"}/include/openssl "$to/include"
  cp "$object"/lib{crypto,ssl}.a "$to/lib"
  rm -r "$object"
}

# Unpacks the headers of Boost 1.81, since libc++ has no longer what Debian's usual version asks for, and compiles its fibers
# for a platform: FOLDER COMPILER-AND-OPTIONS... ARCHIVER.
boost() {
  local source=$PWD/build/platforms/sources/boost1.81 into=$PWD/build/platforms/$1 compile=("${@:2:$#-2}") archive=${*: -1}
  local call processor=x86_64_sysv object
  [[ ! -f $into/lib/libboost_context.a ]] || return 0
  [[ -d $source/libs ]] || source_of boost1.81 'boost/libs/*/include/boost/*' 'boost/libs/context/src/asm/*'
  mkdir -p "$into"/{include,lib}
  cp -r "$source"/libs/*/include/boost "$source"/libs/numeric/*/include/boost "$into/include"
  [[ $1 != *arm64 ]] || processor=arm64_aapcs
  object=$(mktemp -d)
  (cd "$object" && for call in make jump ontop; do
    "${compile[@]}" -c "$source/libs/context/src/asm/${call}_${processor}_macho_gas.S"
  done && "$archive" rcs "$into/lib/libboost_context.a" ./*.o)
  rm -r "$object"
}

# The libraries of the program on macOS: FOLDER TARGET-OF-ZIG TARGET-OF-OPENSSL.
macos_libraries() {
  local zig=$PWD/build/platforms/zig
  # Without these macros, zlib and libpng do not take macOS for the system before it.
  local compile=("$zig/cc" -target "$2-macos.11.0" -w -fno-define-target-os-macros)
  zlib "$1" "${compile[@]}" "$zig/ar"
  libpng "$1" "${compile[@]}" -DPNG_ARM_NEON_OPT=0 "$zig/ar"
  boost "$1" "${compile[@]}" "$zig/ar"
  # Zig lacks the headers of Apple's cryptography, so that the kernel itself is asked for entropy. /etc/ssl has certificates.
  openssl "$1" "$3" "CC=${compile[*]}" "AR=$zig/ar" "RANLIB=$zig/ranlib" -DOPENSSL_NO_APPLE_CRYPTO_RANDOM --openssldir=/etc/ssl
}
