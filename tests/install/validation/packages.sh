#!/usr/bin/env bash
# The parts of an installation, and the Debian packages that are made of them: each holds what it should and no more, says
# what it needs (the libraries that are loaded late, too), has manual pages, completions, copyright and changelogs.
# Whether they install and work: tests/install/clean_root.sh, in scripts/deep_check.sh.
set -euo pipefail
build=${ASDIC_BUILD:?}
fail() { echo "FAILED: $*"; exit 1; }
for tool in cpack dpkg-deb dpkg-shlibdeps; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool here (Debian: cmake, dpkg-dev)"; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
umask 022

# Packages of what is built, quickly: nothing is compressed, nothing is stripped.
cp "$build/CPackConfig.cmake" "$folder/"
(cd "$folder" && cpack --config CPackConfig.cmake -B "$folder/made" -D CPACK_DEBIAN_COMPRESSION_TYPE=none \
  -D CPACK_STRIP_FILES=OFF >log 2>&1) || fail "cpack: $(tail -n 5 "$folder/log")"
cd "$folder/made"
package() { ls "${1}"_*.deb; }
control() { dpkg-deb -f "$(package "$1")" "$2"; }
has() { # has PACKAGE FILE...
  local name=$1 file
  shift
  [ -s "$folder/$name.files" ] || dpkg-deb -c "$(package "$name")" | awk '{ print $6 }' >"$folder/$name.files"
  for file; do grep -qx "\./usr/$file" "$folder/$name.files" || fail "$name has no $file: $(cat "$folder/$name.files")"; done
}
library=$(ls libasdic0*.deb | cut -d_ -f1)
names=(asdic "$library" libasdic-dev)
[ -x "$build/bin/asdic-mpi" ] && names+=(asdic-mpi)
ls "$build"/python/asdic/_core*.so >/dev/null 2>&1 && names+=(python3-asdic)
[ "$(ls ./*.deb | wc -l)" = "${#names[@]}" ] || fail "packages $(ls), expected ${names[*]}"

for name in "${names[@]}"; do
  has "$name" "share/doc/$name/copyright" "share/doc/$name/changelog.gz" "share/doc/$name/changelog.Debian.gz"
  control "$name" Depends | grep -q . || fail "$name depends on nothing"
  [ "$(control "$name" Architecture)" = "$(dpkg --print-architecture)" ] || fail "architecture of $name"
  control "$name" Version | grep -q '^0\|^[1-9]' || fail "version of $name"
done
has asdic bin/asdic-moos share/man/man1/asdic-moos.1.gz share/asdic/ros/asdic_msgs/msg/AudioBlock.msg share/asdic/python/asdic_middleware/moos_app.py
has asdic bin/asdic share/asdic/python/asdic_plot.py share/asdic/scenarios/deep_ocean.toml share/doc/asdic/docs/guide/commands.md \
  share/bash-completion/completions/asdic share/zsh/vendor-completions/_asdic share/fish/vendor_completions.d/asdic.fish
if grep -E 'asdic-mpi|libasdic|_core|/include/|\.pyc' "$folder/asdic.files"; then fail "asdic holds what is of others"; fi

# A manual page for every command, made of its own help.
"$build/bin/asdic" | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p' | sort -u >"$folder/commands"
[ "$(wc -l <"$folder/commands")" -ge 20 ] || fail "commands: $(cat "$folder/commands")"
while read -r command; do has asdic "share/man/man1/asdic-$command.1.gz"; done <"$folder/commands"
has asdic share/man/man1/asdic.1.gz
dpkg-deb --fsys-tarfile "$(package asdic)" | tar -xO ./usr/share/man/man1/asdic-ping.1.gz | gunzip | grep -q 'time\\-axis' ||
  fail "asdic-ping.1 knows no --time-axis"
if dpkg-deb --fsys-tarfile "$(package asdic)" | tar -xO ./usr/share/man/man1/asdic.1.gz | gunzip | grep "$build"; then
  fail "asdic.1 tells of the build"
fi

# What it needs: libraries that it is linked with, and those that it loads when it first calls them.
[ "$(uname -m)" != x86_64 ] || readelf -d "$build/bin/asdic" | grep -q hdf5 | grep . && fail "HDF5 is linked: see AsdicLazy.cmake"
for needed in libc6 libtbb libfmt libtbbmalloc libhdf5-1 libhdf5-hl libnetcdf libsndfile libssl libsqlite3 libfftw3 libmuparser; do
  control asdic Depends | grep -q "$needed" || fail "asdic does not depend on $needed: $(control asdic Depends)"
done
if control asdic Depends | grep -i 'mpi\|python\|-dev'; then fail "asdic depends on more than it needs"; fi
for wished in python3-matplotlib python3-h5py python3-numpy; do
  control asdic Recommends | grep -q "$wished" || fail "asdic does not recommend $wished"
done

has "$library" "$(cd "$build/lib" && realpath --relative-to=. libasdic.so | sed 's,^,lib/,')" 2>/dev/null ||
  grep -q 'libasdic\.so\.[0-9.]*$' "$folder/$library.files" || fail "no library in $library"
dpkg-deb --ctrl-tarfile "$(package "$library")" | tar -tf - >"$folder/library.control"
grep -q triggers "$folder/library.control" && grep -q shlibs "$folder/library.control" || fail "no shlibs or triggers of $library"
has libasdic-dev include/asdic/asdic.h
grep -q 'libasdic\.so$' "$folder/libasdic-dev.files" && grep -q 'asdicConfig.cmake$' "$folder/libasdic-dev.files" ||
  fail "libasdic-dev: $(cat "$folder/libasdic-dev.files")"
control libasdic-dev Depends | grep -q "$library (= " || fail "libasdic-dev depends on another library"
if [[ " ${names[*]} " == *" asdic-mpi "* ]]; then
  has asdic-mpi bin/asdic-mpi share/man/man1/asdic-mpi.1.gz share/man/man1/asdic-mpi-study.1.gz
  control asdic-mpi Depends | grep -q mpi || fail "asdic-mpi depends on no MPI"
fi
if [[ " ${names[*]} " == *" python3-asdic "* ]]; then
  has python3-asdic lib/python3/dist-packages/asdic/__init__.py lib/python3/dist-packages/asdic_pictures/__init__.py
  grep -q 'dist-packages/asdic/_core.*\.so$' "$folder/python3-asdic.files" || fail "no extension in python3-asdic"
  for needed in "$library (= " python3-numpy python3-xarray 'python3 (<< '; do
    control python3-asdic Depends | grep -qF "$needed" || fail "python3-asdic does not depend on $needed"
  done
fi
echo "${#names[@]} packages, $(wc -l <"$folder/commands") commands with manual pages"
