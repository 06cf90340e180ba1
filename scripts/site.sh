#!/bin/sh
# Makes the page that builds scenes in the browser, for any web server: site/ (a folder), and site/voxdag.html, one file that
# works from disk, offline.
#
#   scripts/site.sh [VOXDAG] [FOLDER]
#
# VOXDAG is a program that was built with -DVOXDAG_BROWSER_MODULE (default: build/release/apps/voxdag/voxdag); FOLDER is site.
set -eu
voxdag=${1:-build/release/apps/voxdag/voxdag}
site=${2:-site}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$voxdag" scene sponge --size 1 -o "$work/sponge.ply" -q
"$voxdag" build "$work/sponge.ply" -r 8 -o "$work/sponge.vdag" -q
"$voxdag" export "$work/sponge.vdag" -o "$site/" -q
if [ ! -f "$site/voxdag.html" ]; then
  echo "$0: $voxdag has no program for browsers: build it with -DVOXDAG_BROWSER_MODULE=FOLDER" >&2
  exit 1
fi
# The page begins with the start page, and its policy forbids connections to other hosts.
rm "$site/scene.vdag"
policy="default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; connect-src 'self' blob: data:; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; base-uri 'none'; form-action 'none'"
sed -i -e "s|<meta charset=\"utf-8\">|&\n<meta http-equiv=\"Content-Security-Policy\" content=\"$policy\">|" \
  -e 's|</main>|&\n<script type="text/plain" id="scene"></script>|' "$site/index.html"
echo "$site: $(du -sh "$site" | cut -f1); $site/voxdag.html: $(du -h "$site/voxdag.html" | cut -f1)"
