// Lesson 01: vectors, colors and a file. Writes a gradient as P3, P6 and PNG, and pictures of what vectors compute.
#include "common/image/image_file.h"
#include "common/image/srgb.h"
#include "common/system/parameters.h"
#include "common/vec/vec.h"

#include <cstdio>
#include <fstream>
#include <string>

using namespace duet;

/// A component of linear light as the file's number, 0 to 255.
int to_byte(float linear) { return static_cast<int>(std::lround(255 * srgb_encode(clamp(linear, 0.0f, 1.0f)))); }

/// The first lines of a PPM file: which kind, the width and height, and the largest number.
std::string header(const char* kind, const ImageRgb& image) {
    return message(kind, "\n", image.width(), " ", image.height(), "\n255\n");
}

/// P3: each number as text. A person can read it.
std::string ppm_text(const ImageRgb& image) {
    std::string file = header("P3", image);
    for (const Rgb& pixel : image)
        file += message(to_byte(pixel.r), " ", to_byte(pixel.g), " ", to_byte(pixel.b), "\n");
    return file;
}

/// P6: each number as one byte. A file to keep.
std::string ppm_binary(const ImageRgb& image) {
    std::string file = header("P6", image);
    for (const Rgb& pixel : image)
        for (const float component : {pixel.r, pixel.g, pixel.b}) file += static_cast<char>(to_byte(component));
    return file;
}

/// Without std::ios::binary some systems change the bytes of the file.
void save(const char* path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// The lesson's picture: red grows to the right and green to the top. They grow as squares, since the eye tells dark
/// colors apart better than bright ones. Blue is the same everywhere.
ImageRgb gradient(float blue) {
    ImageRgb image(480, 270);
    for (int row = 0; row < image.height(); ++row)
        for (int column = 0; column < image.width(); ++column) {
            const float x = static_cast<float>(column) / static_cast<float>(image.width() - 1);
            const float y = 1 - static_cast<float>(row) / static_cast<float>(image.height() - 1);
            image(column, row) = Rgb(x * x, y * y, blue);
        }
    return image;
}

/// What a viewer shows that takes the bytes of a file, from byte `begin` on, for the pixels of a P6 file.
ImageRgb misread(const std::string& file, std::size_t begin) {
    ImageRgb image(480, 270);
    for (Rgb& pixel : image.pixels())
        for (std::size_t channel = 0; channel < 3; ++channel)
            pixel[channel] = srgb_decode_8bit(static_cast<std::uint8_t>(file[begin++]));
    return image;
}

/// What a program on Windows writes that forgets std::ios::binary: each byte 10 becomes the two bytes 13 and 10.
std::string written_as_text(const std::string& file) {
    std::string changed;
    for (const char byte : file) changed += byte == '\n' ? std::string("\r\n") : std::string(1, byte);
    return changed;
}

/// Colors beyond 1 whose numbers are not clamped: a byte holds no 256, so it begins at 0 again.
ImageRgb overflowing(ImageRgb image, float factor) {
    for (Rgb& pixel : image.pixels())
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const long number = std::lround(255 * srgb_encode(factor * pixel[channel]));
            pixel[channel] = srgb_decode_8bit(static_cast<std::uint8_t>(number));
        }
    return image;
}

/// A number as a color: orange above zero, blue below, in steps of a quarter.
Rgb step_color(float value) {
    const float step = (std::floor(std::abs(value) * 4) + 0.5f) / 6;
    return lerp(Rgb(0.9f), value > 0 ? Rgb(0.8f, 0.16f, 0.01f) : Rgb(0.01f, 0.1f, 0.5f), clamp(step, 0.0f, 1.0f));
}

/// Four fields: the length of p, a·p, a·(p / |p|), and z of a × p, at each point p of the plane z = 0. The arrow is a.
ImageRgb fields() {
    ImageRgb image(800, 200); // four squares
    const Vec3 a{0.8f, 0.6f, 0};
    for (int row = 0; row < 200; ++row)
        for (int column = 0; column < 800; ++column) {
            const Vec3 p{(static_cast<float>(column % 200) - 99.5f) / 66, (99.5f - static_cast<float>(row)) / 66, 0};
            const float along = dot(a, p), beside = std::abs(cross(a, p).z);
            const bool arrow = along > 0 && beside < (along < 0.75f ? 0.025f : 0.5f * (1 - along));
            const float value[] = {length(p), along, dot(a, normalize(p)), cross(a, p).z};
            image(column, row) = arrow ? Rgb(0.01f) : step_color(value[column / 200]);
        }
    return image;
}

/// A spotlight at the origin that points along a lights each point whose direction makes a smaller angle with a than
/// that of the cone. On the left the direction is p / |p|, on the right it is p itself: the mistake.
ImageRgb spotlights(float degrees) {
    ImageRgb image(472, 200);
    for (int row = 0; row < 200; ++row)
        for (int column = 0; column < 472; ++column) {
            const Vec3 p{static_cast<float>(column % 240 - 10) / 100, static_cast<float>(10 - row) / 100, 0};
            const float cosine = dot(Vec3{0.8f, -0.6f, 0}, column < 240 ? normalize(p) : p);
            const Rgb color = cosine > std::cos(radians(degrees)) ? Rgb(1, 0.7f, 0.25f) : Rgb(0.01f, 0.02f, 0.06f);
            image(column, row) = column % 240 < 232 ? color : Rgb(1);
        }
    return image;
}

/// Grays. The upper strip has even steps of light, the second even steps of the file's numbers. Below, black and white
/// pixels alternate, with two patches: half of the light on the left, and half of the number on the right.
ImageRgb grays() {
    ImageRgb image(480, 270);
    for (int row = 0; row < 270; ++row)
        for (int column = 0; column < 480; ++column) {
            const float step = static_cast<float>(column / 30) / 15;
            const bool left = std::abs(column - 140) < 50, right = std::abs(column - 340) < 50;
            Rgb& pixel = image(column, row);
            if (row < 150)
                pixel = Rgb(row < 75 ? step : srgb_decode(step));
            else if (row > 170 && row < 250 && (left || right))
                pixel = Rgb(left ? 0.5f : srgb_decode(0.5f));
            else
                pixel = Rgb(static_cast<float>((row + column) % 2));
        }
    return image;
}

int main(int argc, char** argv) {
    float blue = 0.25f, factor = 1.6f, angle = 25;
    read_parameters(argc, argv, {{"blue", blue, 0, 1}, {"factor", factor, 0, 4},
                                 {"cone angle", angle, 1, 89, "degrees"}});
    const Vec3 a{1, 2, 3}, b{4, -5, 6}, c = cross(a, b), u = normalize(Vec3{3, 4, 0});
    std::printf("a·b = %g, a×b = (%g, %g, %g), unit = (%g, %g, %g)\n", dot(a, b), c.x, c.y, c.z, u.x, u.y, u.z);
    const ImageRgb image = gradient(blue);
    const std::string text = ppm_text(image), binary = ppm_binary(image);
    save("gradient-p3.ppm", text);
    save("gradient-p6.ppm", binary);
    const bool same = read_image("gradient-p3.ppm").pixels() == read_image("gradient-p6.ppm").pixels();
    std::printf("P3: %zu bytes, P6: %zu bytes\n", text.size(), binary.size());
    write_image("evidence.png", image);
    write_image("fields.png", fields());
    write_image("grays.png", grays());
    write_image("spotlights.png", spotlights(angle));
    write_image("digits.png", misread(text, 15));
    write_image("text-mode.png", misread(written_as_text(binary), 17));
    write_image("overflow.png", overflowing(image, factor));
    return same ? 0 : 1;
}
