# What platforms/setup takes from Debian and Maven Central. The working folder is the checkout.

# Unpacks a package of Maven Central: NAME:VERSION SYSTEM FOLDER.
from_maven() {
  local downloads=$PWD/build/platforms/downloads
  mvn --quiet --batch-mode -Dstyle.color=never dependency:copy "-Dartifact=org.bytedeco:$1:jar:$2" "-DoutputDirectory=$downloads" >&2
  unzip -qo "$downloads/${1/:/-}-$2.jar" 'org/bytedeco/*' -d "$downloads"
  mkdir -p "$3"
  cp -r "$downloads/org/bytedeco/${1%:*}/$2/." "$3"
  rm -rf "$downloads"
}

# apt-get with lists of its own in a FOLDER, of the system's sources as EXPRESSION (of sed) alters them: FOLDER EXPRESSION
# ARGUMENT...
own_apt() {
  mkdir -p "$1"/{lists/partial,parts}
  local apt=(apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$1/parts" -o "Dir::State::lists=$1/lists"
    -o APT::Sandbox::User=root)
  if [[ -z $(find "$1/lists" -maxdepth 1 -type f -size +0 -print -quit) ]]; then
    sed "$2" /etc/apt/sources.list.d/debian.sources >"$1/parts/debian.sources"
    "${apt[@]}" update
  fi
  "${apt[@]}" "${@:3}"
}

# Unpacks the source of a package of Debian, as its authors released it, into build/platforms/sources/PACKAGE, or the files of
# it that match a PATTERN.
source_of() {  # PACKAGE PATTERN...
  local folder=$PWD/build/platforms/sources
  mkdir -p "$folder/$1"
  (cd "$folder" && own_apt "$folder" 's/^Types:.*/Types: deb-src/' source --download-only --tar-only "$1" &&
    tar xf "$1"_*.orig.tar.*z* -C "$1" --strip-components 1 --wildcards "${@:2}")
}
