// The library's vectors (common/vec/vec.h), encoder (common/image/srgb.h) and file format (common/image/formats.h).
#include "common/image/formats.h"
#include "raytrace/lessons/01-vectors/lab.h"

namespace duet::lab {

static Vec3 vec(Vector a) { return {a.x, a.y, a.z}; }
static Vector vector(Vec3 a) { return {a.x, a.y, a.z}; }

float dot(Vector a, Vector b) { return duet::dot(vec(a), vec(b)); }
Vector cross(Vector a, Vector b) { return vector(duet::cross(vec(a), vec(b))); }
Vector normalize(Vector a) { return vector(duet::normalize(vec(a))); }
Vector lerp(Vector a, Vector b, float t) { return vector(duet::lerp(vec(a), vec(b), t)); }
int to_byte(float linear) { return srgb_encode_8bit(linear); }
std::string ppm_text(const ImageRgb& image) { return encode_ppm(image, {.ascii_ppm = true}); }
std::string ppm_binary(const ImageRgb& image) { return encode_ppm(image, {}); }

} // namespace duet::lab
