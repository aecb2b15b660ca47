// Stubs for a build without EGL or OpenGL headers: there is no peer.
#if !defined(DUET_LLVMPIPE)

#include "compare/frames/llvmpipe.h"

#include "common/system/error.h"

namespace duet::compare {

struct LlvmpipeRenderer::State {};

bool LlvmpipeRenderer::built() { return false; }
LlvmpipeRenderer::LlvmpipeRenderer(const Scene&, const View&, int) {
    throw Error("llvmpipe: this program was built without EGL");
}
LlvmpipeRenderer::~LlvmpipeRenderer() = default;
std::string LlvmpipeRenderer::name() const { return {}; }
void LlvmpipeRenderer::draw(FrameWork) {}
ImageRgb LlvmpipeRenderer::image() const { return {}; }
ImageFloat LlvmpipeRenderer::reversed_depth() const { return {}; }

} // namespace duet::compare

#endif
