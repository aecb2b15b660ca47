#include "compare/hits/reference_bvh.h"

#include <algorithm>
#include <numeric>

namespace duet::compare {

namespace {
constexpr std::uint32_t kLeafSize = 4;
}

ReferenceBvh::ReferenceBvh(const std::vector<Box3d>& boxes) : items_(boxes.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    nodes_.reserve(boxes.size());
    if (!boxes.empty()) build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

std::uint32_t ReferenceBvh::build(const std::vector<Box3d>& boxes, std::uint32_t first, std::uint32_t count) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Box3d box, centers;
    for (std::uint32_t i = first; i < first + count; ++i) {
        box.extend(boxes[items_[i]]);
        centers.extend(boxes[items_[i]].center());
    }
    nodes_.push_back({box, first, count});
    if (count <= kLeafSize) return index;

    const std::size_t axis = longest_axis(centers.diagonal());
    const std::uint32_t half = count / 2;
    const auto begin = items_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].center()[axis] < boxes[b].center()[axis];
    });
    build(boxes, first, half);
    const std::uint32_t right = build(boxes, first + half, count - half);
    nodes_[index].first = right;
    nodes_[index].count = 0;
    return index;
}

} // namespace duet::compare
