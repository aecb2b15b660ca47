// This header reads the published means of the Cornell box (tests/golden/README.md).
#pragma once

#include "common/image/rgb.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace duet {

/// Stores the published mean of a block of 32 x 32 pixels of the image of 512 x 512 pixels. Blocks that are not listed
/// are black.
struct CornellBlock {
    int row = 0, column = 0;
    Rgbd mean;

    bool holds_light() const { return row == 4 && (column == 7 || column == 8); }
};

inline std::vector<CornellBlock> published_means() {
    std::ifstream in(DUET_SOURCE_DIR "/tests/golden/cornell-box-means.csv");
    std::vector<CornellBlock> blocks;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#' || line[0] == 'b') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        CornellBlock block;
        fields >> block.row >> block.column >> block.mean.r >> block.mean.g >> block.mean.b;
        REQUIRE(fields);
        blocks.push_back(block);
    }
    return blocks;
}

} // namespace duet
