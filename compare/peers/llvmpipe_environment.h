// This file makes Mesa draw on the CPU.
#pragma once

#include <array>
#include <string>
#include <utility>

namespace duet::compare {

/// Returns the environment variables that make Mesa's OpenGL draw with llvmpipe on so many threads. With one thread,
/// the calling thread does the work itself, which avoids handing over to a thread on the same processor.
inline std::array<std::pair<std::string, std::string>, 3> llvmpipe_environment(int threads) {
    return {{{"GALLIUM_DRIVER", "llvmpipe"},
             {"LIBGL_ALWAYS_SOFTWARE", "1"},
             {"LP_NUM_THREADS", std::to_string(threads > 1 ? threads : 0)}}};
}

} // namespace duet::compare
