// Guards that a test build can take away by name, and the test that must fail then.
#pragma once

#include "common/system/sabotage.h"

#include <span>
#include <string>
#include <string_view>

namespace duet::compare {

struct Sabotage {
    Guard guard;
    std::string_view name;
    std::string_view test; ///< of `compare stress`: fails without the guard
};

/// One for each Guard, in their order.
std::span<const Sabotage> sabotages();
/// Takes the guard of that name away, from now on. Throws Error listing the names where there is none, and in any build
/// but the sabotage one.
void remove_guard(const std::string& name);

} // namespace duet::compare
