// `compare view --measure`: how fast the window is.
#pragma once

#include "compare/view/window/app.h"

namespace duet::compare {

/// Turns the camera once around for `seconds`, with the path tracer paused and then running, and lets it rest for as
/// long. Prints a table, and writes JSON to ViewOptions::stats: for both turns `median_ms` and `p95_ms` between two
/// images of the rasterizer, and their mean `scale`; `drag`: the same for images of each pipeline while an object is
/// dragged, or null; `samples_per_second` of the path tracer in the window and alone.
void measure(App& app, Window& window, const ViewOptions& options);

} // namespace duet::compare
