#include "compare/bench/bench_report.h"

#include "common/image/plot.h"

#include <algorithm>

namespace duet::compare {

Plot bench_plot(const SceneResult& result) {
    Plot plot{.title = std::filesystem::path(result.scene).stem().string() + ": error against time",
              .x_label = "seconds",
              .y_label = "relMSE",
              .log_x = true,
              .log_y = true,
              .timing = true};
    for (const Measurement& m : result.rows) {
        if (!(m.relmse.value > 0) || !(m.seconds.value > 0) || !m.counted) continue;
        auto series = std::ranges::find(plot.series, m.name(), &Series::name);
        if (series == plot.series.end()) {
            if (plot.series.size() == Plot::kMaxSeries) continue;
            series = plot.series.insert(series, {m.name(), {}});
        }
        series->points.push_back({m.seconds.value, m.relmse.value});
    }
    return plot;
}

} // namespace duet::compare
