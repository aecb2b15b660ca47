// This main function runs a fuzz target once on each file that it is given: the inputs of corpus/, which any compiler
// can build and every test run replays.
#include "common/system/file.h"

#include <cstdint>
#include <cstdio>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int count, char** files) {
    if (count < 2) return 2; // a replay of nothing must not pass
    for (int i = 1; i < count; ++i) {
        std::fprintf(stderr, "%s\n", files[i]); // the last line tells which input crashes
        const std::string bytes = duet::read_file(files[i]);
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    return 0;
}
