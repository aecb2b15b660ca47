// This file declares the peer of `compare frames`: Mesa's software rasterizer llvmpipe, used through OpenGL.
#pragma once

#include "common/image/image.h"
#include "common/scene/scene.h"

#include <cstdint>
#include <memory>
#include <string>

namespace duet::compare {

/// Selects the work of a frame.
enum class FrameWork {
    kPhong, ///< clears, transforms, shades each pixel by Phong's model, encodes to 8-bit sRGB in memory
    kDepth, ///< clears, transforms, writes depth
};
/// Returns the name in tables, "phong" or "depth".
const char* name(FrameWork work);

/// Draws a scene of one mesh and one sun (frame_scene.h) with OpenGL. Vertices and image stay in buffers of the
/// driver. The context is surfaceless and needs no display. Only one LlvmpipeRenderer may exist at a time, used by the
/// thread that created it.
class LlvmpipeRenderer {
public:
    /// Returns whether this program was built with EGL and OpenGL. Without them there is no peer.
    static bool built();

    /// `threads` is the number of rasterizer threads, on the processors that this thread may currently use.
    /// Throws Error if EGL has no such renderer here.
    LlvmpipeRenderer(const Scene& scene, const View& view, int threads);
    ~LlvmpipeRenderer();
    LlvmpipeRenderer(const LlvmpipeRenderer&) = delete;
    LlvmpipeRenderer& operator=(const LlvmpipeRenderer&) = delete;

    std::string name() const; ///< driver's name, such as "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6"
    /// Draws one frame and waits until it is finished. Nothing is read back.
    void draw(FrameWork work);
    /// Returns the image of the last frame, which must be of FrameWork::kPhong, as sRGB-encoded values in [0, 1].
    ImageRgb image() const;
    /// Returns the last frame's reversed depth, near/depth; 0 where nothing is visible.
    ImageFloat reversed_depth() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::compare
