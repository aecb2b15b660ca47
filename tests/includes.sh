#!/bin/sh
# Includes go down the house, never up: a room includes what design and README allow, a floor of common/ only itself and
# those below. A lesson includes only what was explained before. No two units include each other, directly or not.
# usage: includes.sh SOURCE_DIR
set -eu
cd "$1"
common="vec image sampling geometry camera texture material light medium scene program"
raster="geometry visibility shader gbuffer screen_space shadows lighting fog probes shading output overlay"
raytrace="sampling film acceleration integrator bidirectional wavefront denoise"
grep -rnoE '#include "[^"]+"' common raster raytrace compare models tests --include='*.h' --include='*.cpp' |
    awk -F: -v common="$common" -v raster="$raster" -v raytrace="$raytrace" '
    function floors_of(room, list) { n = split(list, names, " "); for (i = 1; i <= n; ++i) floor[room, names[i]] = i }
    BEGIN { floors_of("common", common); floors_of("raster", raster); floors_of("raytrace", raytrace) }
    # A lesson includes the small stable floor, the header of its parameters, and the headers of its own folder and of
    # earlier lessons of its room; its lab has the contract that the grader calls, too. A lesson of compare/ comes after
    # those of both other rooms. The assignments, and what else stands in compare/lessons/, may include all.
    function lesson() {
        if (from[1] == "compare" && from[3] !~ /^[0-9][0-9]-/) return
        if (to[1] == "tests" && to[2] == "grading" && $1 ~ /\/lab(_test|_starter)?\.(h|cpp)$/) return
        if (to[1] == "common" && (to[2] == "vec" || to[2] == "image")) return
        if (target == "common/system/parameters.h") return
        if ((to[1] != from[1] && from[1] != "compare") || to[2] != "lessons") \
            fault("a lesson includes common/vec, common/image, its parameters and earlier lessons alone")
        else if (substr(to[3], 1, 2) > substr(from[3], 1, 2)) fault("a lesson includes no later lesson")
        else if ($1 ~ /\/lab(_starter)?\.(h|cpp)$/ && to[3] == from[3] && to[4] != "lab.h") \
            fault("this header holds the answer of the lab")
    }
    function fault(why) { print $1 ":" $2 ": " target ": " why; ++faults }
    {
        target = $3; sub(/^#include "/, "", target); sub(/"$/, "", target)
        split($1, from, "/"); split(target, to, "/")
        if (!(to[1] ~ /^(common|raster|raytrace|compare|tests|models)$/)) { \
            fault("name the file from the top of the repository"); next }
        if (from[1] == "tests") next
        if (from[2] == "lessons") { lesson(); next }
        if (from[1] == "models" && to[1] != "common" && to[1] != "models") fault("models/ includes only common/")
        if (from[1] == "common" && to[1] != "common") fault("common/ includes nothing of the other rooms")
        if ((from[1] == "raster" || from[1] == "raytrace") && to[1] != "common" && to[1] != from[1])
            fault(from[1] "/ includes only common/ and itself")
        # Files at the top of a room are its interface, which all of its floors may include.
        if (from[1] != to[1] || from[2] == to[2] || from[1] == "compare" || from[1] == "models") next
        if (from[2] ~ /\./ || to[2] ~ /\./ || to[2] == "system") next
        if (from[2] == "system") fault("system/ includes no floor")
        else if (!((from[1], from[2]) in floor)) fault(from[1] "/" from[2] " is no floor: add it to tests/includes.sh")
        else if (!((to[1], to[2]) in floor)) fault(to[1] "/" to[2] " is no floor: add it to tests/includes.sh")
        else if (floor[to[1], to[2]] > floor[from[1], from[2]])
            fault("goes up from " from[2] "/ to " to[2] "/: move the definition")
    }
    END { exit faults > 0 }'
# No circle between units either: a header, and the source of the same name, is one unit.
grep -rnoE '^#include "[^"]+"' common raster raytrace compare models --include='*.h' --include='*.cpp' |
    grep -v '^[a-z]*/lessons/' |
    sed -E 's/\.(h|cpp):[0-9]+:#include "(.*)\.h"/ \2/' | awk '$1 != $2' | tsort >/dev/null
