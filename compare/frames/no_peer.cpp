// Stubs for a build without EGL or OpenGL headers: there is no peer.
#if !defined(DUET_LLVMPIPE)

#include "compare/frames/peer.h"

#include "common/system/error.h"

namespace duet::compare {

struct Peer::State {};

bool Peer::built() { return false; }
Peer::Peer(const Scene&, const View&, int) { throw Error("llvmpipe: this program was built without EGL"); }
Peer::~Peer() = default;
std::string Peer::name() const { return {}; }
void Peer::draw(FrameWork) {}
ImageRgb Peer::picture() const { return {}; }
ImageFloat Peer::nearness() const { return {}; }

} // namespace duet::compare

#endif
