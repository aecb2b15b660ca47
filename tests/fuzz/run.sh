# Fuzzes the readers of files: sh tests/fuzz/run.sh [INPUTS] [TARGET ...]
# Each target (image, obj, scene, film; all by default) gets INPUTS mutated inputs, 100000 by default, two targets at a
# time. Inputs that reach new code are kept in build/fuzz/corpus; those that crash, hang for 20 s or take 4 GiB are
# written to build/fuzz/faults, and the script then fails.
set -eu
cd "$(dirname "$0")/../.."
inputs=${1:-100000}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- image obj scene film

cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DDUET_FUZZ=ON \
    > build/fuzz.log
cmake --build build/fuzz --target fuzz >> build/fuzz.log || { tail -20 build/fuzz.log; exit 1; }
mkdir -p build/fuzz/faults
rm -f build/fuzz/faults/summary
for target in "$@"; do mkdir -p "build/fuzz/corpus/$target"; done

# UndefinedBehaviorSanitizer is fatal by the compiler's options; a reader may refuse what it can't allocate.
export ASAN_OPTIONS=allocator_may_return_null=1
[ ! -d /dev/shm ] || export TMPDIR=/dev/shm # files in memory
echo "$@" | tr ' ' '\n' | xargs -P 2 -I{} sh -c 'build/fuzz/bin/{}_fuzz \
    -runs='"$inputs"' -timeout=20 -rss_limit_mb=4096 -max_len=16384 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/faults/{}- build/fuzz/corpus/{} tests/fuzz/corpus/{} > build/fuzz/{}.log 2>&1 ||
    echo "{}: a fault, see build/fuzz/{}.log" >> build/fuzz/faults/summary'
grep -H "number_of_executed_units\|average_exec_per_sec" $(printf 'build/fuzz/%s.log ' "$@") || true
! cat build/fuzz/faults/summary 2> /dev/null
