// Shows base colors without lighting.
#include "raster/shader/program.h"
#include "raster/shadings/shadings.h"

namespace duet::raster {
namespace {

struct AlbedoShader : NoVaryings {
    template <typename T, typename F> RgbT<T> fragment(const F& f) const { return f.base_color(); }
};

} // namespace

std::unique_ptr<Program> albedo_program() { return std::make_unique<ProgramOf<AlbedoShader>>(AlbedoShader{}); }

} // namespace duet::raster
