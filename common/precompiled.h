// These are the headers that most sources include and that take longest to parse. They are compiled once (option
// DUET_PRECOMPILE of CMakeLists.txt). Each source includes what it uses all the same, because the option may be off.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <xsimd/xsimd.hpp>
