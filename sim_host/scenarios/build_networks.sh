#!/usr/bin/env bash
# Builds FOLDER/network.net.xml from the plain XML sources beside it, for every scenario (or those named).
# Needs netconvert (Debian package sumo). What it writes is committed: nothing else needs SUMO.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
folders=("$@")
if [ ${#folders[@]} -eq 0 ]; then
  for source in */network.nod.xml; do folders+=("${source%/*}"); done
fi
for folder in "${folders[@]}"; do
  sources=(-n "$folder/network.nod.xml" -e "$folder/network.edg.xml" -x "$folder/network.con.xml")
  # Coordinates stay those of the sources; curves in 20 points and 0.1 mm, so that curvature is smooth.
  netconvert "${sources[@]}" -o "$folder/network.net.xml" --no-turnarounds true \
    --offset.disable-normalization true --junctions.internal-link-detail 20 --precision 4 --no-warnings true \
    --xml-validation never >/dev/null
  # The generator's comment holds the date and paths of one machine.
  sed -i '/^<!-- generated on/,/^-->/d; /^$/d' "$folder/network.net.xml"
done
