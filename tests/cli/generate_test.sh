# The program `generate`: its help, and what it refuses.
. tests/cli/support.sh

expect 0 "$bin/tools/generate" --help
grep -q "test-ball:" "$scratch/stdout" || fail "--help does not list the models"
expect 0 "$bin/tools/generate" "$scratch/made" bowl
[ -s "$scratch/made/meshes/bowl.obj" ] || fail "generate DIR bowl made no bowl"
expect 2 "$bin/tools/generate" "$scratch/made" dragon
one_line_error "dragon"

# What looks like an option is none, and no folder.
cd "$scratch"
expect 2 "$bin/tools/generate" --list
one_line_error "no such option"
expect 2 "$bin/tools/generate" made -x
one_line_error "no such option"
[ ! -e ./--list ] || fail "generate --list made a folder"
finish
