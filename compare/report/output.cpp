#include "compare/report/output.h"

#include "common/system/error.h"

namespace duet::compare {

namespace fs = std::filesystem;

fs::path make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw Error(
            message(folder.string(), ": the folder cannot be made: ", error ? error.message() : "a file is there"), 1);
    return folder;
}

} // namespace duet::compare
