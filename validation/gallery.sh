#!/usr/bin/env bash
# gallery.sh [FOLDER]: renders the pictures of the READMEs with build/exactff into data/pictures, or into FOLDER. Takes
# some minutes. The times in the strip are those of this machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${1:-data/pictures}
mkdir -p "$out"

render() {  # NAME SCENE [FLAG...]
  local name=$1
  shift
  build/exactff render "$@" -o "$out/$name.png" --force
}

box=(data/scenes/cornell_box.obj --eye 278 273 -800 --look 278 273 0 --fov 39.30764811610662)
# The rays of area-sampling take about as long as the exact values.
render cornell_box_strip "${box[@]}" --size 224x224 --against area-sampling:samples=64 --strip --times
render cornell_box "${box[@]}" --size 400x400 --spp 3
render blinds_room data/scenes/blinds_room.obj --eye 3.7 1.75 4.5 --look 0.9 0.95 0.2 --fov 48 --size 400x300 --spp 2 --exposure 6
render blind_penumbra @room:n=6 --eye 2 1.5 1.2 --look 0 1.5 1.2 --ortho 2.7 --size 320x300 --exposure 9
render closed_room @closed-room:lamp=hanging --fov 62 --size 400x300 --spp 2
render emitters @emitters --fov 60 --size 400x300 --spp 2
render teapot @teapot:segments=12 --eye 4 -8 6.5 --look 0.1 0 1.3 --up 0 0 1 --fov 36 --size 400x300 --spp 2 --exposure 28
render forest @forest:n=1500,trees=9,cover=0.6 --two-sided --eye 12 -13 1.7 --look -4 5 3.4 --up 0 0 1 --fov 55 --size 256x192
build/exactff view data/scenes/cornell_box.obj --at 240 0 300 --normal 0 1 0 --on floor --up 0 0 1 --plain \
  --svg "$out/cornell_box_view.svg" > /dev/null
ls -l "$out"
