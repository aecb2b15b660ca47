// Runs tasks whose results may reach any pixel on all threads, and adds the results in a fixed order.
#pragma once

#include "common/system/parallel.h"
#include "raytrace/render_pass.h"

#include <algorithm>
#include <mutex>
#include <vector>

namespace duet::raytrace {

/// Calls body(i, result, counts) once for each i in [0, count), in parallel, and then add(result) in the order of i, so
/// that sums do not depend on threads. `group` results are stored at a time. The counts are added to those of the pass.
/// Returns false if it was stopped.
template <typename Result, typename Body, typename Add>
bool run_in_order(const PassContext& context, std::size_t count, std::size_t group, const Body& body, const Add& add) {
    std::mutex mutex; // guards the counts
    for (std::size_t first = 0; first < count; first += group) {
        std::vector<Result> results(std::min(group, count - first));
        parallel_for(results.size(), context.settings.threads, [&](std::size_t i) {
            if (context.control.stopped()) return;
            RayCounts counts;
            body(first + i, results[i], counts);
            const std::lock_guard lock(mutex);
            context.counts += counts;
        });
        if (context.control.stopped()) return false;
        for (const Result& result : results) add(result);
    }
    return true;
}

} // namespace duet::raytrace
