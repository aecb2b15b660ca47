// This header ends a fuzz target where a result is wrong.
#pragma once

#include <cstdlib>

namespace duet {

inline void require(bool condition) {
    if (!condition) std::abort();
}

} // namespace duet
