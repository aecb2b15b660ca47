#include "common/medium/medium.h"

#include "common/medium/density_grid.h"

namespace duet {

float density_at(const Medium& medium, Vec3 p) { return medium.density ? medium.density->density(medium.box, p) : 1; }

PassedColumn follow(const Medium& medium, const Ray& ray, Interval inside, float column) {
    if (medium.density) {
        const DensityGrid::Reached reached =
            medium.density->follow(medium.box, ray, inside, static_cast<double>(column));
        return {reached.t, static_cast<float>(reached.column)};
    }
    const float length = inside.end - inside.begin;
    return column < length ? PassedColumn{inside.begin + column, column} : PassedColumn{kInfinity, length};
}

} // namespace duet
