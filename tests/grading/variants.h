// Several submissions of one lab in one worker (variants.py). Each is compiled in a namespace of its own: variants.py
// defines `lab` as lab_0, lab_1 … before it copies the contract and the submission's text. A worker whose file is named
// worker-3 runs number 3.
#pragma once

#include "tests/grading/lab.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace duet::grading {

using Table = bool (*)(std::string_view name, Reader& in, Writer& out);
inline void submission_not_attempted() { lab::not_attempted(); }
inline std::size_t number_of_variant() {
    return static_cast<std::size_t>(std::atoi(std::strrchr(program_invocation_name, '-') + 1));
}

} // namespace duet::grading

// In a variant a contract's list of functions becomes the table named DUET_TABLE.
#undef DUET_LAB
#define DUET_LAB(...)                                                                                                  \
    static bool DUET_TABLE(std::string_view name, ::duet::grading::Reader& in, ::duet::grading::Writer& out) {         \
        DUET_LAB_EXPAND(DUET_LAB_CASES(__VA_ARGS__))                                                                   \
        return false;                                                                                                  \
    }
