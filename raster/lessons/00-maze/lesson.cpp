// Lesson 00: a maze. Writes what a viewer in the maze sees, a map with the rays, and pictures of mistakes.
#include "common/image/image_file.h"

#include "common/system/parameters.h"
using namespace duet;

/// The maze from above. Dots are free, and letters are walls: b, g, r are colors, s has a sign, capitals have torches.
const char* const kMaze[] = {"bbbbbbbbbbbbbbbbb", "b...b.......b...b", "b.b.b.BbsbB.b.b.b", "b.b...........b.b",
                             "b.bbbg.....rbbb.b", "b.....G...r.....b", "bbb.b.g...R.rrrrr", "g.........r.....r",
                             "g.g.g.G.......r.r", "g.g...g...R...r.r", "g.ggg.G...r.rrr.r", "g...............r",
                             "g.g.ggg...rrr.r.r", "g.g...........r.r", "g...............r", "ggGgggGgsrRrrrRrr"};
const char* const kSign[] = {".................", ".##..#.#.###.###.", ".#.#.#.#.#....#..", ".#.#.#.#.##...#..",
                             ".#.#.#.#.#....#..", ".##..###.###..#..", "................."};

char square_at(int x, int y) { return kMaze[y][x]; } // column x, row y
bool has_torch(char square) { return square >= 'A' && square <= 'Z'; }
float fraction(float x) { return x - std::floor(x); }

/// Where a ray meets a wall: at the point eye + ray * t.
struct Hit {
    float t = 0;
    char square = '.';
    bool on_side = false;      ///< on the west or east side of the square
    std::vector<Vec2> checked; ///< where the program looked for a wall; the last point is on the wall
};

/// Goes along a ray from one line of the grid to the next, until it enters a wall. (Amanatides and Woo 1987)
Hit cast(Vec2 eye, Vec2 ray) {
    int x = static_cast<int>(eye.x), y = static_cast<int>(eye.y);
    const float step_x = 1 / std::abs(ray.x), step_y = 1 / std::abs(ray.y); // t from one line to the next
    float next_x = step_x * (ray.x < 0 ? fraction(eye.x) : 1 - fraction(eye.x));
    float next_y = step_y * (ray.y < 0 ? fraction(eye.y) : 1 - fraction(eye.y));
    Hit hit;
    for (; hit.square == '.'; hit.square = square_at(x, y)) {
        hit.on_side = next_x < next_y;
        hit.t = min(next_x, next_y);
        if (hit.on_side) x += ray.x < 0 ? -1 : 1, next_x += step_x;
        if (!hit.on_side) y += ray.y < 0 ? -1 : 1, next_y += step_y;
        hit.checked.push_back(eye + ray * hit.t);
    }
    return hit;
}

/// A mistake: equal steps, until one ends in a wall. The side is a guess: that of the nearer line of the grid.
Hit cast_by_steps(Vec2 eye, Vec2 ray, float step) {
    Hit hit;
    for (Vec2 p = eye; hit.square == '.'; hit.square = square_at(static_cast<int>(p.x), static_cast<int>(p.y))) {
        hit.t += step, p = eye + ray * hit.t;
        hit.on_side = std::abs(p.x - std::round(p.x)) < std::abs(p.y - std::round(p.y));
        hit.checked.push_back(p);
    }
    return hit;
}

/// The light at a point of the maze: that of all torches, and a little from everywhere.
Rgb light_at(Vec2 p) {
    Rgb light(0.07f, 0.08f, 0.16f);
    for (int i = 0; i < 17 * 16; ++i) {
        const Vec2 way = Vec2{static_cast<float>(i % 17) + 0.5f, static_cast<float>(i / 17) + 0.5f} - p;
        if (has_torch(square_at(i % 17, i / 17))) light += Rgb(1, 0.55f, 0.22f) * (0.9f / (0.15f + dot(way, way)));
    }
    return light;
}

/// The color of a wall in a light, from (u, v) = (0, 0) at its upper left corner to (1, 1) at its lower right one.
Rgb wall_color(char square, float u, float v, Rgb light) {
    Rgb color(0.45f, 0.36f, 0.2f);
    if (square == 'b' || square == 'B') color = {0.1f, 0.22f, 0.6f};
    if (square == 'g' || square == 'G') color = {0.14f, 0.42f, 0.16f};
    if (square == 'r' || square == 'R') color = {0.6f, 0.13f, 0.08f};
    const float row = std::floor(v * 8), along = u * 4 + fraction(row / 2), brick = fraction(std::floor(along) / 4);
    color *= 0.75f + 0.5f * fraction(std::sin(row * 5 + brick * 29) * 43); // each brick has a brightness of its own
    if (fraction(along) < 0.06f || fraction(v * 8) < 0.12f) color *= 0.3f; // the gaps between bricks
    if (square == 's' && v >= 0.25f && v < 0.75f) {
        const char dot = kSign[static_cast<int>(v * 14 - 3.5f)][static_cast<int>(u * 17)];
        color = dot == '#' ? Rgb(0.95f, 0.7f, 0.15f) : Rgb(0.35f, 0.02f, 0.04f);
    }
    color = {color.r * light.r, color.g * light.g, color.b * light.b};
    const Vec2 from_flame{(u - 0.5f) * 3, (v - 0.38f) * (v < 0.38f ? 1.5f : 4.0f)};
    if (has_torch(square)) color += Rgb(3, 1.1f, 0.2f) * std::exp(-70 * dot(from_flame, from_flame));
    return color;
}

struct Viewer {
    Vec2 eye, forward;  ///< forward has length 1
    float side = 0.65f; ///< how far a ray at the border of the image goes aside for each step forward
    /// The ray through a place in the image: -1 is the left border, 1 the right border.
    Vec2 ray(float place) const { return forward + Vec2{-forward.y, forward.x} * (side * place); }
};
enum class Mistake { kNone, kFishEye, kSteps, kMirrored };

/// Draws what the viewer sees into some columns of an image.
void draw_view(ImageRgb& image, int left, int width, const Viewer& viewer, Mistake mistake = Mistake::kNone) {
    const float scale = static_cast<float>(width) / (2 * viewer.side); // the height, in pixels, of a wall at distance 1
    for (int column = 0; column < width; ++column) {
        const Vec2 ray = viewer.ray((2 * static_cast<float>(column) + 1) / static_cast<float>(width) - 1);
        Hit hit = mistake == Mistake::kSteps ? cast_by_steps(viewer.eye, ray, 0.25f) : cast(viewer.eye, ray);
        if (mistake == Mistake::kFishEye) hit.t *= std::sqrt(dot(ray, ray));
        float u = fraction(hit.on_side ? hit.checked.back().y : hit.checked.back().x);
        if (mistake != Mistake::kMirrored && (hit.on_side ? ray.x < 0 : ray.y > 0)) u = 1 - u;
        const Rgb light = light_at(hit.checked.back()) * (hit.on_side ? 0.65f : 1.0f);
        for (int y = 0; y < image.height(); ++y) {
            const float below = static_cast<float>(y) + 0.5f - 0.5f * static_cast<float>(image.height());
            const float t = min(hit.t, 0.5f * scale / std::abs(below));
            Rgb color = light_at(viewer.eye + ray * t) * (below > 0 ? 0.16f : 0.07f);
            if (t == hit.t) color = wall_color(hit.square, u, 0.5f + below * t / scale, light);
            image(left + column, y) = lerp(Rgb(0.012f, 0.012f, 0.04f), color, std::exp(-0.1f * t)); // fog
        }
    }
}

/// Draws the maze from above into some columns of an image: squares, rays, and dots where walls were looked for.
void draw_map(ImageRgb& image, int left, int width, Vec2 corner, float scale, Vec2 eye, const std::vector<Hit>& hits) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2 p = corner + Vec2{static_cast<float>(x), static_cast<float>(y)} * (1 / scale);
            const char square = square_at(static_cast<int>(p.x), static_cast<int>(p.y));
            const Vec2 in{fraction(p.x), fraction(p.y)}; // (0, 0) is the square's corner
            Rgb color = square != '.' ? wall_color(square, in.x, in.y, Rgb(0.5f)) : Rgb(0.02f);
            if (square == '.' && min(in.x, in.y) * scale < 1) color = Rgb(0.06f); // the lines of the grid
            for (const Hit& hit : hits) {
                const Vec2 ray = hit.checked.back() - eye, way = p - eye;
                const Vec2 off = way - ray * clamp(dot(way, ray) / dot(ray, ray), 0.0f, 1.0f); // from the ray to p
                if (dot(off, off) * scale * scale < 0.4f) color = Rgb(0.9f, 0.6f, 0.1f);
                for (const Vec2 q : hit.checked)
                    if (max(std::abs(q.x - p.x), std::abs(q.y - p.y)) < 0.07f) color = Rgb(1);
            }
            image(left + x, y) = color;
        }
}

int main(int argc, char** argv) {
    Viewer viewer{{8.8f, 11.2f}, {}};
    float turn = 0.12f;
    read_parameters(argc, argv, {{"turn", turn, -3.1f, 3.1f, "radians"}, {"side", viewer.side, 0.1f, 2}});
    viewer.forward = {-std::sin(turn), -std::cos(turn)};
    std::vector<Hit> hits;
    for (float place = -1; place <= 1; place += 0.125f) hits.push_back(cast(viewer.eye, viewer.ray(place)));
    ImageRgb evidence(760, 256, Rgb(1)), walk(648, 240, Rgb(1)); // white shows between two parts
    draw_view(evidence, 0, 480, viewer), draw_map(evidence, 488, 272, {0, 0}, 16, viewer.eye, hits);
    const Vec2 eye{7.5f, 11.07f}, ray{1, -0.75f};
    write_image("evidence.png", evidence);
    draw_map(walk, 0, 320, {7.2f, 6.6f}, 50, eye, {cast(eye, ray)});
    draw_map(walk, 328, 320, {7.2f, 6.6f}, 50, eye, {cast_by_steps(eye, ray, 0.58f)});
    write_image("walk.png", walk);
    const auto pair = [](const char* name, const Viewer& v, Mistake mistake) {
        ImageRgb image(648, 180, Rgb(1));
        draw_view(image, 0, 320, v);
        draw_view(image, 328, 320, v, mistake);
        write_image(name, image);
    };
    pair("fish-eye.png", {{8.5f, 13.6f}, {0, 1}, 1.3f}, Mistake::kFishEye);
    pair("steps.png", viewer, Mistake::kSteps);
    pair("mirrored.png", {{8.5f, 13.5f}, {0, 1}}, Mistake::kMirrored);
}
