#!/usr/bin/env bash
# gallery.sh [FOLDER]: renders the pictures of the pages with build/exactff (EXACTFF_BUILD names another build folder)
# into data/pictures, or into FOLDER: 1,200 pixels wide, with 3 x 3 points a pixel; those of all light are smaller. Takes about
# an hour on two cores, most of it for the forest. The same program gives the same bytes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=${EXACTFF_BUILD:-build}/exactff
out=${1:-data/pictures}
mkdir -p "$out"

render() {  # NAME SCENE [FLAG...]
  local name=$1
  shift
  "$program" render "$@" --spp 3 -o "$out/$name.png" --force
}

box=(data/scenes/cornell_box.obj --eye 278 273 -800 --look 278 273 0 --fov 39.30764811610662)
render cornell_box_strip "${box[@]}" --size 396x396 --against area-sampling:samples=16 --strip
render cornell_box_slope "${box[@]}" --size 480x480 --quantity gradient --exposure 4000
render cornell_box "${box[@]}" --size 1200x1200 --exposure 16
cells=$(mktemp -d)
trap 'rm -r "$cells"' EXIT
for length in 140 278; do
  "$program" radiosity "${box[0]}" --divide $length --accuracy 1e-3 --budget 1000 -o "$cells/c$length.csv" > /dev/null ||
    [ $? -eq 3 ] # wider than asked
done
all() {  # LENGTH SIZE IMAGE [FLAG...]
  local solution=$cells/c$1.csv size=$2 image=$3
  shift 3
  "$program" render "${box[@]}" --size "$size" --radiosity "$solution" -o "$image" --force "$@"
}
all 140 400x400 "$out/cornell_box_all_light.png" --exposure 16
all 278 200x200 "$cells/c278.exr"
all 140 200x200 "$out/cornell_box_cells.png" --against "$cells/c278.exr" --strip
render blinds_room @room:n=12 --eye 3.9 2 3.8 --look 0.5 0.6 0.9 --fov 62 --size 1200x900 --exposure 10
render slats data/scenes/slats.obj --eye -0.6 2.9 -1.8 --look 0.3 0 1.4 --fov 46 --size 1200x900 --exposure 40
render closed_room @closed-room:boxes=4,seed=5 --eye 0.2 2.2 3.85 --look 3.2 1 1.3 --fov 70 --size 1200x900 --exposure 10
render emitters @emitters:n=9,size=0.1 --eye 9.8 2.4 9.8 --look 5 1 5 --fov 68 --size 1200x900
render teapot @teapot:segments=16 --eye 3 -5.5 6.5 --look 0.4 0.1 1.1 --up 0 0 1 --fov 38 --size 1200x900 --exposure 22
render forest @forest:n=400,trees=1,cover=0.12,light=sun --two-sided --eye 16 -13 8.4 --look 5.7 4.7 4.1 --up 0 0 1 --fov 47 \
  --size 1200x900
map=(data/scenes/lightmap_room.obj --lightmap 512x512)
"$program" render "${map[@]}" --method area-sampling:samples=16 -o "$cells/baked.exr"
"$program" render "${map[@]}" --against "$cells/baked.exr" --strip -o "$out/lightmap_strip.png" --force
"$program" view data/scenes/cornell_box.obj --at 240 0 300 --normal 0 1 0 --on floor --up 0 0 1 --plain \
  --svg "$out/cornell_box_view.svg" > /dev/null
"$program" point @teapot:segments=8 --at -3 0.4 0 --normal 0 0 1 --on floor --source light --plain \
  --svg "$out/teapot_outline.svg" > /dev/null
"$program" point data/scenes/blinds_room.obj --at 3 0 3.3 --normal 0 1 0 --source window --method adaptive:eps_B=0.01 --plain \
  --svg "$out/blinds_leaves.svg" > /dev/null
ls -l "$out"
