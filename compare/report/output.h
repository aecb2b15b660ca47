// This file prepares output folders, so that errors show before a long render and not after it.
#pragma once

#include <filesystem>

namespace duet::compare {

/// Creates the folder if it is missing and returns it. Throws Error (exit code 1) if it cannot be created.
std::filesystem::path make_folder(const std::filesystem::path& folder);

} // namespace duet::compare
