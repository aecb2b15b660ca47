// This header declares the guards that a fault-injection build can remove by name, and the test that must then fail.
#pragma once

#include "common/system/sabotage.h"

#include <span>
#include <string>
#include <string_view>

namespace duet::compare {

struct Sabotage {
    Guard guard;
    std::string_view name;
    std::string_view test; ///< test of `compare stress` that fails without the guard
};

/// Returns one entry for each Guard, in the same order.
std::span<const Sabotage> sabotages();
/// Removes the guard of this name from now on. Throws Error, listing the names, if there is no such guard, and in any
/// build other than the fault-injection build.
void remove_guard(const std::string& name);

} // namespace duet::compare
