#!/usr/bin/env bash
# What a scene does not use costs it nothing: instructions of tracing one that does not use X, by luxel as it is and by luxel
# without X (`--cfg luxel_cut="X"`, src/trace/cut.rs). Prints a table; fails where they differ by more than 1 %.
#
#     benches/cuts.sh [X...]        all by default
#
# Needs valgrind. Instructions are counted while `trace_tile` runs, one thread, and pictures must be equal. Builds are
# incremental, all of them, so that each compiles what a cut changes.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${LUXEL_CUTS:-target/cuts}
mkdir -p "$target"

# A shipped scene that does not use X: a mesh of flat triangles for what is about those, else spheres.
scene_without() {
    case $1 in
    smooth_normals | instances) echo scenes/cat_flat.ron ;;
    *) echo scenes/diffuse_room.ron ;;
    esac
}

# The flag reaches luxel alone, so that what it depends on is built once; cargo does not see it, so that it is told of a change.
wrapper=$(realpath "$target")/rustc
printf '#!/bin/sh\nexec "$@" ${LUXEL_CUT:+--cfg "luxel_cut=\\"$LUXEL_CUT\\""}\n' >"$wrapper"
chmod +x "$wrapper"
build() {
    touch src/lib.rs
    LUXEL_CUT=$1 CARGO_INCREMENTAL=1 RUSTC_WORKSPACE_WRAPPER=$wrapper \
        cargo build --release --bin luxel --target-dir "$target" --quiet
    cp "$target/release/luxel" "$target/luxel.$1"
}

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        --toggle-collect='luxel::trace::path::Tracer::trace_tile*' \
        "$target/luxel.$1" render "$2" --size 64x64 --spp 8 --threads 1 -o "$target/cut.$1.png" 2>&1 |
        sed -n 's/.*Collected : //p'
}

needs=("$@")
if [ ${#needs[@]} -eq 0 ]; then
    needs=(lens smooth_normals textures vertex_colors opacity instances background environment
        punctual mirror glass plastic metal)
fi
build ''
echo "| cut out | scene without it | instructions as it is | cut | difference |"
echo "|---|---|---:|---:|---:|"
failed=0
for need in "${needs[@]}"; do
    scene=$(scene_without "$need")
    build "$need"
    whole=$(instructions '' "$scene")
    cut=$(instructions "$need" "$scene")
    cmp "$target/cut..png" "$target/cut.$need.png"
    awk -v need="$need" -v scene="$(basename "$scene" .ron)" -v whole="$whole" -v cut="$cut" 'BEGIN {
        off = 100 * (whole - cut) / cut
        printf "| `%s` | `%s` | %d | %d | %+.2f %% |\n", need, scene, whole, cut, off
        exit off > 1
    }' || failed=1
done
exit $failed
