# Sourced by the tests of the programs: sh NAME_test.sh BIN_DIR SCRATCH_DIR, run from the repository's top.
set -eu
bin=$1
scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# expect CODE COMMAND…: runs it; standard output and error go to $scratch/stdout and stderr.
expect() {
    expected=$1
    shift
    code=0
    "$@" >"$scratch/stdout" 2>"$scratch/stderr" || code=$?
    [ "$code" -eq "$expected" ] || {
        fail "$* : exit code $code, expected $expected; standard error:"
        cat "$scratch/stderr"
    }
}

# one_line_error TEXT: the last command's standard error is one line that contains TEXT.
one_line_error() {
    lines=$(wc -l <"$scratch/stderr")
    [ "$lines" -eq 1 ] || {
        fail "expected one line on standard error, found $lines:"
        head -5 "$scratch/stderr"
    }
    grep -qF -- "$1" "$scratch/stderr" || {
        fail "the message lacks «$1»:"
        head -5 "$scratch/stderr"
    }
}

# terminated SECONDS COMMAND…: runs it, sends SIGTERM after so long, and expects the exit code 130.
terminated() {
    seconds=$1
    shift
    "$@" &
    process=$!
    sleep "$seconds"
    kill -TERM $process || fail "$* : ended by itself"
    code=0
    wait $process || code=$?
    [ "$code" -eq 130 ] || fail "SIGTERM: exit code $code, expected 130"
}

# nothing_in FOLDER: an interrupted run has left no file, hidden or not.
nothing_in() {
    [ -z "$(ls -A "$1")" ] || fail "SIGTERM: $(ls -A "$1") was left behind"
}

finish() {
    [ "$failures" -eq 0 ] || exit 1
    echo "all checks passed"
}
