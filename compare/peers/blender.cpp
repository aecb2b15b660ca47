#include "compare/peers/blender.h"

#include "common/image/image_file.h"
#include "common/system/file.h"
#include "compare/peers/llvmpipe_environment.h"
#include "compare/peers/subprocess.h"
#include "compare/peers/temporary_folder.h"

#include <charconv>
#include <deque>
#include <span>

namespace duet::compare {

/// These are the scripts in compare/peers/blender/, embedded by CMakeLists.txt.
extern const std::span<const std::pair<std::string_view, std::string_view>> kBlenderScripts; // names and texts

namespace {

namespace fs = std::filesystem;

/// Returns the number after `label` in a line of the log, or nothing.
std::optional<double> number_after(const std::string& line, std::string_view label) {
    const std::size_t at = line.find(label);
    if (at == std::string::npos) return std::nullopt;
    double value = 0;
    const char* const begin = line.data() + at + label.size();
    return std::from_chars(begin, line.data() + line.size(), value).ec == std::errc() ? std::optional(value)
                                                                                      : std::nullopt;
}

} // namespace

/// The member order ensures that the folder is deleted last, after Blender has ended.
class BlenderPeer::Process {
public:
    Process(BlenderEngine engine, const Scene& scene, const View& view, const ExportSettings& settings)
        : notes_(export_scene(folder_.path(), scene, view, settings)),
          blender_(command(engine, folder_.path(), settings.threads)) {}

    const ExportNotes& notes() const { return notes_; }
    const std::string& program() const { return program_; } ///< known once the script is ready
    fs::path image() const { return folder_.path() / "picture.exr"; }

    void send(const std::string& line) {
        if (!blender_.write_line(line)) fail();
    }

    /// Reads lines until the script prints `word`. Returns the last render time logged before it (0 if none),
    /// or nothing if stopped.
    std::optional<double> wait_for(const std::string& word, const Control& control) {
        double seconds = 0;
        while (!control.stopped()) {
            const Subprocess::Read read = blender_.read_line(std::chrono::milliseconds(100));
            if (read.status == Subprocess::Status::kTimeout) continue;
            if (read.status == Subprocess::Status::kEnd) { // may be due to the interrupt signal
                if (control.stopped()) break;
                fail();
            }
            if (read.line == word) return seconds;
            if (read.line.starts_with(kVersionPrefix)) program_ = read.line.substr(kVersionPrefix.size());
            if (const auto time = number_after(read.line, "Render time (without synchronization): ")) seconds = *time;
            last_lines_.push_back(read.line);
            if (last_lines_.size() > 8) last_lines_.pop_front();
        }
        return std::nullopt;
    }

private:
    static std::vector<std::string> command(BlenderEngine engine, const fs::path& folder, int threads) {
        for (const auto& [name, text] : kBlenderScripts) write_file(folder / name, text);
        const bool eevee = engine == BlenderEngine::kEevee;
        std::vector<std::string> all;
        if (eevee) {
            all = {"xvfb-run", "--auto-servernum", "env"};
            for (const auto& [name, value] : llvmpipe_environment(threads)) all.push_back(name + "=" + value);
        }
        const std::vector<std::string> blender{
            "blender", "-b", "--factory-startup", "-noaudio", "--debug-cycles", "--python-exit-code", "3", "--python",
            (folder / "main.py").string(), "--", folder.string(), eevee ? "eevee" : "cycles"};
        all.insert(all.end(), blender.begin(), blender.end());
        return all;
    }

    [[noreturn]] void fail() const {
        std::string text = "Blender ended:";
        for (const std::string& line : last_lines_) text += " | " + line;
        throw Error(text, 1);
    }

    TemporaryFolder folder_{"duet-blender"};
    ExportNotes notes_;
    Subprocess blender_;
    std::deque<std::string> last_lines_;
    static constexpr std::string_view kVersionPrefix = "duet: ";
    std::string program_;
};

void check_blender(BlenderEngine engine) {
    const auto check = [](const char* program, const char* package) {
        if (!is_installed(program))
            throw Error(message("--peer: ", program, " is not in PATH; install it (Debian, Ubuntu: apt-get install ",
                                package, ")"));
    };
    check("blender", "blender");
    if (engine == BlenderEngine::kEevee) check("xvfb-run", "xvfb");
}

BlenderPeer::BlenderPeer(BlenderEngine engine, const Scene& scene, const View& view, const ExportSettings& settings)
    : engine_(engine) {
    if (engine == BlenderEngine::kEevee && !scene.media.empty())
        throw Error(message(scene.path.string(), ": cannot be exported: EEVEE is not set up for media"));
    process_ = std::make_unique<Process>(engine, scene, view, settings);
}

BlenderPeer::~BlenderPeer() = default;

const ExportNotes& BlenderPeer::notes() const { return process_->notes(); }

bool BlenderPeer::wait_until_ready(const Control& control) {
    ready_ = ready_ || process_->wait_for("duet: ready", control).has_value();
    return ready_;
}

std::string BlenderPeer::program(const Control& control) {
    return wait_until_ready(control) ? process_->program() : "";
}

TimedImage BlenderPeer::render(const Job& job, Control& control) {
    if (!wait_until_ready(control)) return {};
    const fs::path image = process_->image();
    // Cycles' seeds have 31 bits.
    process_->send(message(job.spp, ' ', job.seed % 0x7fffffff, ' ', job.adaptive ? 1 : 0, ' ', image.string()));
    const std::optional<double> seconds = process_->wait_for("duet: rendered", control);
    if (!seconds) return {};
    if (!(*seconds > 0)) throw Error("Blender's log tells no render time: another version than 3.x and 4.x?", 1);
    return {read_image(image), *seconds, 0};
}

ImageRgb BlenderPeer::unbiased_image(int spp, std::uint64_t seed, Control& control) {
    DUET_CHECK_LE(2, spp);
    const ImageRgb all = render({spp, seed, false}, control).image;
    const ImageRgb first = render({1, seed, false}, control).image;
    if (all.empty() || first.empty()) return {};
    ImageRgb others(all.width(), all.height());
    const double n = spp;
    for (std::size_t i = 0; i < all.size(); ++i) others[i] = Rgb((Rgbd(all[i]) * n - Rgbd(first[i])) / (n - 1));
    return others;
}

std::vector<BenchRenderer> blender_renderers(const std::shared_ptr<BlenderPeer>& peer, const std::vector<int>& spps) {
    const auto renderer = [&](const char* technique, const char* sampler, const std::string& note, bool adaptive) {
        return BenchRenderer{technique, sampler, note, spps,
                             [peer, adaptive](int spp, std::uint64_t seed, Control& control) {
                                 return peer->render({spp, seed, adaptive}, control);
                             }};
    };
    if (peer->engine() == BlenderEngine::kEevee) {
        std::string note = "EEVEE rasterizes: shadow maps, light probes and what the screen shows.";
        for (const std::string& approximation : peer->notes()) note += " Its scene: " + approximation + ".";
        return {renderer("eevee", "", note, false)};
    }
    return {renderer("cycles", "fixed", "", false), renderer("cycles", "adaptive", "", true)};
}

} // namespace duet::compare
