#!/usr/bin/env bash
# Writes OUT/s4tp-VERSION.tar.gz: what is committed and nothing else; the same bytes wherever and whenever it is made.
#
#   release.sh OUT [COMMIT]
set -euo pipefail
[[ $# == 1 || $# == 2 ]] || { sed -n 's/^#   /usage: /p' "${BASH_SOURCE[0]}" >&2; exit 2; }
out=$(realpath "$1")
commit=${2:-HEAD}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
version=$(git show "$commit:CMakeLists.txt" | sed -nE 's/^project\(s4tp VERSION ([0-9.]+).*/\1/p')
name=s4tp-$version
mkdir -p "$out"
# The times in it are the commit's, its modes nobody's umask; gzip keeps no time.
git -c tar.umask=0022 -c core.autocrlf=false archive --format=tar --prefix="$name/" "$commit" | gzip -9n >"$out/$name.tar.gz"
cd "$out"
sha256sum "$name.tar.gz"
