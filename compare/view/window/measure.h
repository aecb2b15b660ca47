// `compare view --measure` measures how fast the window is.
#pragma once

#include "compare/view/window/app.h"

namespace duet::compare {

/// Turns the camera once around for `seconds`, first with the path tracer paused and then with it running. The camera
/// then rests for as long. Prints a table, and writes JSON to ViewOptions::stats. For both turns it has `median_ms` and
/// `p95_ms` between two images of the rasterizer, and their mean `scale`. `drag` has the same for images of each
/// pipeline while an object is dragged, or null. `samples_per_second` is that of the path tracer in the window and
/// alone.
void measure(App& app, Window& window, const ViewOptions& options);

} // namespace duet::compare
