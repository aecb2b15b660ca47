// Several submissions of one lab in one worker (variants.py). A worker whose file is named worker-3 runs number 3.
#pragma once

#include "tests/grading/lab.h"
#include "tests/grading/wire.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace duet::grading {

using Table = bool (*)(std::string_view name, Reader& in, Writer& out);
inline std::size_t number_of_variant() {
    return static_cast<std::size_t>(std::atoi(std::strrchr(program_invocation_name, '-') + 1));
}

} // namespace duet::grading

// The functions that calls can reach are those of the variant, not those that the contract names.
#undef DUET_LAB
#define DUET_LAB(...)
