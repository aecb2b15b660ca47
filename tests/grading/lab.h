// What the contract of a lab (lab.h in a lesson's folder) needs: `not_attempted`, and the list of its functions.
#pragma once

namespace duet::lab {

/// Stands in each function of a starter until the student begins. It tells the grader that what the function returns
/// isn't an answer yet.
void not_attempted();

} // namespace duet::lab

// DUET_LAB(f, g, …) at the end of a contract names its functions, all in namespace duet::lab. It expands to nothing but
// in the worker (worker.cpp), where it becomes the table by which the examiner's calls find them.
#ifndef DUET_LAB_WORKER
#define DUET_LAB(...)
#else
#include "tests/grading/wire.h"

namespace duet::grading {

/// Reads the arguments of a function, calls it, writes its result.
template <typename Result, typename... Args> void answer(Result (*function)(Args...), Reader& in, Writer& out) {
    std::tuple<std::remove_cvref_t<Args>...> arguments{in.get<std::remove_cvref_t<Args>>()...};
    out.put<std::remove_cvref_t<Result>>(std::apply(function, arguments));
}
/// Calls the lab's function of that name. False where there is none.
bool call_by_name(std::string_view name, Reader& in, Writer& out);

} // namespace duet::grading

#define DUET_LAB_PARENTHESES ()
#define DUET_LAB_EXPAND(...) DUET_LAB_EXPAND3(DUET_LAB_EXPAND3(DUET_LAB_EXPAND3(__VA_ARGS__)))
#define DUET_LAB_EXPAND3(...) DUET_LAB_EXPAND2(DUET_LAB_EXPAND2(DUET_LAB_EXPAND2(__VA_ARGS__)))
#define DUET_LAB_EXPAND2(...) __VA_ARGS__
#define DUET_LAB_CASES(f, ...)                                                                                         \
    if (name == #f) return answer(&::duet::lab::f, in, out), true;                                                     \
    __VA_OPT__(DUET_LAB_AGAIN DUET_LAB_PARENTHESES(__VA_ARGS__))
#define DUET_LAB_AGAIN() DUET_LAB_CASES
#define DUET_LAB(...)                                                                                                  \
    bool duet::grading::call_by_name(std::string_view name, Reader& in, Writer& out) {                                 \
        DUET_LAB_EXPAND(DUET_LAB_CASES(__VA_ARGS__))                                                                   \
        return false;                                                                                                  \
    }
#endif
