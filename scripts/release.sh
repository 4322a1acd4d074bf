#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Makes the archive of a release from the last commit, and checks it as a user would meet it:
#   scripts/release.sh [DIR]   writes DIR/taut-VERSION.tar.gz and DIR/notes.md (DIR: build/release)
#   scripts/release.sh --tag   the same, and then the tag vVERSION with the notes; it pushes nothing
# The version must be one in include/taut/core/version.hpp, CITATION.cff and CHANGELOG.md. README's first program must
# compile from the unpacked archive, without anything else of the repository, and run.
# CXX, CXXFLAGS (-O1) and EIGEN, a folder, may be set. --tag needs a clean tree, and a date behind the version in the
# changelog.
set -eu
cd "$(dirname "$0")/.."
root=$PWD

die() {
    echo "release: $*" >&2
    exit 1
}

tag=false
if [ "${1:-}" = --tag ]; then
    tag=true
    shift
fi
out=${1:-build/release}
mkdir -p "$out"
out=$(cd "$out" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git archive --format=tar HEAD include/taut/core/version.hpp CITATION.cff CHANGELOG.md | tar -x -C "$work"
version=$(sed -n 's/^#define TAUT_VERSION_[A-Z]* \([0-9]*\)$/\1/p' "$work/include/taut/core/version.hpp" |
    paste -s -d . -)
case $version in
    *.*.*) ;;
    *) die "version.hpp states no version: '$version'" ;;
esac
grep -q "^version: $version\$" "$work/CITATION.cff" || die "CITATION.cff is not of version $version"
heading=$(sed -n 's/^## //p' "$work/CHANGELOG.md" | head -n 1)
case $heading in
    "$version ("*) ;;
    *) die "CHANGELOG.md begins with '$heading', not with $version" ;;
esac
awk '/^## / { ++n; next } n == 1' "$work/CHANGELOG.md" >"$out/notes.md"
[ -n "$(tr -d '[:space:]' <"$out/notes.md")" ] || die "CHANGELOG.md says nothing of $version"
rm -r "${work:?}"/*

name=taut-$version
git archive --format=tar.gz --prefix="$name/" -o "$out/$name.tar.gz" HEAD
tar -xzf "$out/$name.tar.gz" -C "$work"
cd "$work"
for file in LICENSE README.md CMakeLists.txt include/taut/taut.hpp scripts/single_header.cmake; do
    [ -s "$name/$file" ] || die "the archive has no $file"
done
awk '/^```cpp$/ { inside = 1; text = ""; next }
     /^```$/ { if (inside && text ~ /int main/) { printf "%s", text; exit } inside = 0 }
     inside { text = text $0 "\n" }' "$name/README.md" >first.cpp
[ -s first.cpp ] || die "README.md shows no program"
eigen=${EIGEN:-$(pkg-config --cflags-only-I eigen3 2>/dev/null | sed 's/^ *-I//; s/ *$//')}
# shellcheck disable=SC2086  # flags are a list of words
${CXX:-c++} -std=c++17 ${CXXFLAGS:--O1} -Wall -Wextra -Werror -isystem "${eigen:-/usr/include/eigen3}" -I"$name/include" first.cpp -o first ||
    die "README's first program does not compile from the archive"
./first || die "README's first program fails"
cd "$root"

echo "release: $out/$name.tar.gz, $(wc -c <"$out/$name.tar.gz") bytes; its first program compiles and runs"
if $tag; then
    [ -z "$(git status --porcelain)" ] || die "the tree has changes that are not committed"
    case $heading in
        *unreleased*) die "CHANGELOG.md calls $version unreleased: write the date there, and commit it" ;;
    esac
    git tag --annotate --cleanup=verbatim --file "$out/notes.md" "v$version"
    echo "release: tagged v$version; git push origin v$version publishes it"
fi
