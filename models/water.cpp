// This file generates water.obj: the surface of a pool in a light wind.
#include "models/generate.h"
#include "models/mesh_builder.h"
#include "models/random.h"

#include <array>
#include <cmath>

namespace duet::models {
namespace {

/// Represents waves as sums of sines that run in random directions around that of the wind. Their height falls with
/// their length.
class Waves {
public:
    Waves() {
        Random random(5);
        for (Wave& wave : waves_) {
            const double length = 0.25 * std::pow(6, random.uniform()), angle = 0.4 + random.uniform(-1.1, 1.1);
            const double number = 2 * kPiDouble / length;
            wave = {number * std::cos(angle), number * std::sin(angle), random.uniform(0, 2 * kPiDouble),
                    0.0022 * std::pow(length, 1.2)};
        }
    }
    double height(double x, double z) const {
        double sum = 0;
        for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.x * x + wave.z * z + wave.phase);
        return sum;
    }

private:
    struct Wave {
        double x, z, phase, amplitude;
    };
    std::array<Wave, 32> waves_;
};

} // namespace

void write_water(const std::filesystem::path& folder) {
    constexpr double kWidth = 4, kLength = 6;
    const Waves waves;
    ParametricSurface surface;
    surface.columns = 160;
    surface.rows = 240;
    surface.point = [&](double s, double t) {
        const double x = kWidth * (s - 0.5), z = kLength * (0.5 - t);
        return Vec3d(x, waves.height(x, z), z);
    };
    MeshBuilder mesh;
    add_parametric_surface(mesh, surface);
    compute_normals(mesh, 90);
    write_obj(folder / kWaterFile, mesh, "The surface of a pool, 4 m x 6 m, made by models/water.cpp.");
}

} // namespace duet::models
