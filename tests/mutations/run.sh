#!/bin/sh
# Mutation testing: says for each patch of this folder whether a test notices it. See --help, or tests/README.md.
set -eu
self=tests/mutations/run.sh
help() {
    cat <<END
usage: sh $self [--check] [NAME...]

Duet's numerics have guards: formulas, orders and margins without which an image is wrong only in rare or extreme cases.
Each NAME.patch in tests/mutations removes one guard (a mutation). A good test suite notices every one of them.
This script copies the tracked files to build/mutations/tree and builds them there. It then takes one mutation after the
other: it applies the patch to the copy, builds, runs the tests that the patch names, prints whether they failed, and
reverts the patch. Your checkout stays as it is. Before the first mutation, the same tests must pass without any.

  NAME       only these mutations (default: all); NAME is the file's name without .patch
  --check    build nothing; verify only that each patch applies to this checkout and names tests that exist
  --help     print this text

The lines above the diff of a patch are for people, but for one of these lines, which names the tests that must fail:
  Noticed-by: compare stress --only leak/edges
  Noticed-by: ctest -R unit:raster/clip_test.cpp

Results go to standard output, progress to standard error, the logs of each mutation to build/mutations/NAME.log.
A mutation of a header that every file includes takes as long as a full build; ccache shortens the way back.
CMAKE_BUILD_PARALLEL_LEVEL sets the number of compilers. Exit codes: 0 all noticed, 1 not, 2 wrong arguments.

Examples:
  sh $self --check
  sh $self film-doubles near-clip
To add a mutation: edit a source, write a description and a Noticed-by line to tests/mutations/NAME.patch, append the
output of git diff, revert the source, and run the script with NAME.
END
}

root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
patches=$root/tests/mutations
work=$root/build/mutations
tree=$work/tree

fail() { # MESSAGE: ends the script as for wrong arguments
    echo "$self: $1" >&2
    exit 2
}
all_names() { (cd "$patches" && ls ./*.patch | sed 's|^./||; s|\.patch$||'); }
header() { sed '/^diff --git /,$d' "$patches/$1.patch"; }                 # NAME: the lines above the diff
noticed_by() { header "$1" | sed -n 's/^Noticed-by: //p'; }               # NAME: the command of the tests
# Applies a patch in a folder. It starts at /, because below the top of a repository git apply would skip all files.
git_apply() { # FOLDER ARGUMENTS...
    folder=$1
    shift
    (cd / && git apply --directory="${folder#/}" "$@")
}

check=false
names=''
for argument; do
    case $argument in
    --check) check=true ;;
    --help | -h)
        help
        exit 0
        ;;
    -*) fail "found $argument, expected --check, --help or the names of mutations" ;;
    *)
        [ -f "$patches/$argument.patch" ] ||
            fail "found $argument, expected one of: $(all_names | tr '\n' ' ')"
        names="$names $argument"
        ;;
    esac
done
[ -n "$names" ] || names=$(all_names)
set -- $names

# Prints what is wrong with a patch, if anything.
check_patch() { # NAME
    command=$(noticed_by "$1")
    [ -n "$(header "$1" | sed '/^Noticed-by: /d; /^$/d')" ] || echo "$1.patch: expected a description above the diff"
    case $command in
    'compare stress --only '*)
        row=${command#compare stress --only }
        grep -qF "\"$row\"" compare/stress/*.cpp || echo "$1.patch: compare stress has no test $row"
        ;;
    'ctest -R '*:*)
        file=${command#ctest -R *:}
        [ -f "tests/$file" ] || echo "$1.patch: there is no tests/$file"
        ;;
    *)
        echo "$1.patch: found «Noticed-by: $command», expected one such line," \
            "with «compare stress --only TEST» or «ctest -R LABEL:FILE»"
        ;;
    esac
    git_apply "$root" --check "$patches/$1.patch" 2>&1 | sed "s|${root#/}/||; s|^|$1.patch: |"
}
faults=$(for name; do check_patch "$name"; done)
if [ -n "$faults" ]; then
    echo "$faults"
    echo "$self: a patch does not fit this checkout. Make its change by hand, and replace its diff by git diff's." >&2
    exit 1
fi
if $check; then
    echo "$# mutations apply and name tests that exist"
    exit 0
fi

# Makes the copy equal to the tracked files. Files that are equal keep their times, so that the build stays incremental.
copy_tree() {
    git -c core.quotePath=false ls-files 2>/dev/null >"$work/tracked" || true
    [ -s "$work/tracked" ] || fail "this folder is no git checkout; expected one, to know which files to copy"
    sort "$work/tracked" | while read -r file; do
        [ -f "$file" ] || continue
        echo "$file"
        cmp -s "$file" "$tree/$file" && continue
        mkdir -p "$tree/$(dirname "$file")"
        cp "$file" "$tree/$file"
    done >"$work/files"
    [ ! -f "$work/copied" ] || comm -13 "$work/files" "$work/copied" | while read -r file; do rm -f "$tree/$file"; done
    mv "$work/files" "$work/copied"
}
build() { # LOG: builds what the mutations need
    (cd "$tree" && cmake --build --preset release --target $targets) >"$1" 2>&1
}
# Runs tests in the copy. Returns 0 if they passed, 1 if they failed as tests do, 2 if they ended in another way.
run_tests() { # LOG COMMAND
    code=0
    case $2 in
    'compare '*) (cd "$tree" && timeout 900 sh -c "build/release/bin/$2 --quiet") >>"$1" 2>&1 || code=$? ;;
    *) (cd "$tree" && ctest --preset release --no-tests=error ${2#ctest }) >>"$1" 2>&1 || code=$? ;;
    esac
    case $code in
    0) return 0 ;;
    1 | 8) grep -qE '^compare: .* trials failed|tests failed out of' "$1" && return 1 ;; # 8: a failed test of ctest
    esac
    echo "exit code $code" >>"$1"
    return 2
}
start=$(date +%s)
minutes() { # SECONDS
    [ "$1" -lt 90 ] && echo "$1 s" || echo "$((($1 + 30) / 60)) min"
}

mkdir -p "$tree"
targets=compare
for name; do
    case $(noticed_by "$name") in ctest*) targets='compare duet_tests' ;; esac
done
echo "copying and building $tree (the first time takes as long as a full build)" >&2
copy_tree
(cd "$tree" && sh common/setup.sh release) >"$work/unmutated.log" 2>&1 && build "$work/unmutated.log" || {
    tail -20 "$work/unmutated.log" >&2
    echo "$self: the tree does not build without a mutation; the whole log is $work/unmutated.log" >&2
    exit 1
}
for name; do noticed_by "$name"; done | sort -u >"$work/commands"
while read -r command; do
    run_tests "$work/unmutated.log" "$command" </dev/null || {
        echo "$self: «$command» fails without a mutation; mend that first. The log is $work/unmutated.log" >&2
        exit 1
    }
done <"$work/commands"
echo "without a mutation, all these tests pass ($(minutes $(($(date +%s) - start))))" >&2

start=$(date +%s)
done=0
missed=0
for name; do
    left=''
    [ $done -eq 0 ] || left=", about $(minutes $((($(date +%s) - start) * ($# - done) / done))) left"
    done=$((done + 1))
    echo "[$done/$#] $name$left" >&2
    command=$(noticed_by "$name")
    log=$work/$name.log
    cp "$patches/$name.patch" "$work/patch" # reverted as applied, though somebody edits it meanwhile
    git_apply "$tree" "$work/patch"
    result=3
    if build "$log"; then
        result=0
        run_tests "$log" "$command" || result=$?
    fi
    git_apply "$tree" -R "$work/patch"
    case $result in
    1) echo "$name noticed by $command$(sed -n 's/^compare: [^:]*\(: .* trials failed\).*/\1/p' "$log" | head -1)" ;;
    0) echo "$name NOT NOTICED by $command" ;;
    2) echo "$name NOT NOTICED: $command ended with $(tail -1 "$log"), but no test failed" ;;
    3) echo "$name DOES NOT BUILD" ;;
    esac
    [ $result -eq 1 ] || {
        missed=$((missed + 1))
        echo "  its log: $log" >&2
    }
done
echo "$done mutations, $missed not noticed ($(minutes $(($(date +%s) - start))))"
[ $missed -eq 0 ]
