# The root of AArch64 with its Python, for platforms/setup. The working folder is the checkout.

# What a root of AArch64 has: libraries to link, for the program and statically, and Python 3.11 to test with.
aarch64_packages=(zlib1g{-dev,} libpng{-dev,16-16} libssl{-dev,3} libspdlog{-dev,1.10} libfmt{-dev,9} libtomlplusplus{-dev,3}
  libedit{-dev,2} libbsd{-dev,0} libmd{-dev,0} libncurses-dev libtinfo6 libboost-context1.74{-dev,.0} nlohmann-json3-dev
  {python3.11,libpython3.11}-minimal libpython3.11-{stdlib,dev} libc6 libgcc-s1 libstdc++6
  libexpat1 libffi8 libbz2-1.0 liblzma5 libsqlite3-0 libuuid1)

# Makes the root in build/platforms/aarch64, which qemu-user takes for that of the system.
aarch64_root() {
  local folder=$PWD/build/platforms/apt root=$PWD/build/platforms/aarch64 package link
  local python=$root/3.11/python
  if [[ -f $root/packages && $(<"$root/packages") == "${aarch64_packages[*]}" ]]; then return; fi
  local apt=(apt-get -qq --config-file "$folder/arm64.conf")
  rm -rf "$root" "$folder/packages"
  mkdir -p "$folder/lists/partial" "$folder/archives/partial" "$folder/packages" "$root/libraries" "${python%/*}"
  # A list of packages of its own: the system's names only its own architecture. platforms/packages reads it, too.
  cat >"$folder/arm64.conf" <<CONF
APT::Architecture "arm64";
APT::Architectures "arm64";
APT::Sandbox::User "root";
Dir::State::lists "$folder/lists";
Dir::State::status "/dev/null";
Dir::Cache "$folder";
CONF
  "${apt[@]}" update
  (cd "$folder/packages" && "${apt[@]}" download "${aarch64_packages[@]}")
  for package in "$folder"/packages/*.deb; do
    dpkg-deb --extract "$package" "$root"
    # dpkg-shlibdeps finds here what the .deb depends on.
    dpkg-deb --info "$package" shlibs >/dev/null 2>&1 || continue
    dpkg-deb --raw-extract "$package" "$root/libraries/$(dpkg-deb --field "$package" Package)"
  done
  # Links to libraries are those of a system.
  while read -r link; do ln -snf "$root$(readlink "$link")" "$link"; done < <(find "$root/usr/lib/aarch64-linux-gnu" -maxdepth 1 -lname '/*')
  python3 -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --platform manylinux_2_28_aarch64 \
    --platform manylinux2014_aarch64 --python-version 3.11 --only-binary :all: --target "$root/3.11/lib/site-packages" \
    numpy gymnasium --requirement tests/support/requirements.txt >&2
  cat >"$python" <<'RUN'
#!/usr/bin/env bash
root=$(dirname "$(dirname "$(readlink -f "$0")")")
export PYTHONHOME=$root/usr PYTHONPATH=$root/3.11/lib/site-packages${PYTHONPATH:+:$PYTHONPATH} PYTHONDONTWRITEBYTECODE=1
exec qemu-aarch64-static -L "$root" -0 "$root/3.11/python" "$root/usr/bin/python3.11" "$@"
RUN
  cat >"$root/shlibdeps" <<'RUN'
#!/usr/bin/env bash
libraries=("$(dirname "$(readlink -f "$0")")"/libraries/*)
DEB_HOST_ARCH=arm64 exec dpkg-shlibdeps "${libraries[@]/#/-S}" "$@"
RUN
  chmod +x "$python" "$root/shlibdeps"
  echo "${aarch64_packages[*]}" >"$root/packages"
}
