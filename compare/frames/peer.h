// The peer of `compare frames`: Mesa's software rasterizer llvmpipe, by way of OpenGL ES.
#pragma once

#include "common/image/image.h"
#include "common/scene/scene.h"

#include <cstdint>
#include <memory>
#include <string>

namespace duet::compare {

/// What a frame is.
enum class FrameWork {
    kPhong, ///< clear, transform, shade each pixel by Phong's model, encode to 8-bit sRGB in memory
    kDepth, ///< clear, transform, keep the depths
};
const char* name(FrameWork work);

/// A card's view of a scene of one mesh and one sun (frame_scene.h): its vertices lie in buffers on the card's side,
/// its picture stays there. Surfaceless: needs no display. One at a time, used by the thread that made it.
class Peer {
public:
    /// Whether this program was built with EGL and OpenGL ES, without which there is no peer.
    static bool built();

    /// `threads`: of the rasterizer, on the processors that this thread may use now. Throws Error where EGL has no
    /// such renderer here.
    Peer(const Scene& scene, const View& view, int threads);
    ~Peer();
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    std::string name() const; ///< as the driver gives it: "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6"
    /// One frame, finished when it returns; nothing is read back.
    void draw(FrameWork work);
    /// The picture of the last frame drawn, of FrameWork::kPhong: sRGB-encoded values in [0, 1].
    ImageRgb picture() const;
    /// The depths of the last frame drawn, as near/depth: 0 where nothing is seen.
    ImageFloat nearness() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::compare
