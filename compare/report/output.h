// Where a subcommand's results go: found out before a long render, not after.
#pragma once

#include <filesystem>

namespace duet::compare {

/// The folder, made if it is missing. Throws Error where that cannot be.
std::filesystem::path make_folder(const std::filesystem::path& folder);

} // namespace duet::compare
