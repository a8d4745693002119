#include <fstream>
#include <iostream>
#include <stdexcept>

#include "base/files.hpp"
#include "commands/commands.hpp"
#include "commands/session_scenes.hpp"
#include "engine/encoder.hpp"
#include "engine/frame_quality.hpp"
#include "engine/images.hpp"
#include "observe/log.hpp"
#include "renderer/renderer.hpp"
#include "report.hpp"
#include "room/replay.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

namespace {

/// Writes the session's frames as JPEG files, as clients could have got them.
class FrameWriter {
public:
    FrameWriter(fs::path folder, std::optional<int> device) : folder_(std::move(folder)), renderer_(device) {
        fs::create_directories(folder_);
    }

    void write(std::int64_t frame, const room::Room& room) {
        engine::PictureLimits limits;
        limits.max_side = std::min(limits.max_side, renderer_.max_size());
        const protocol::Quality quality =
            engine::quality_of(engine::kRefined, room.view_size(), limits, true);
        const engine::PictureSize size = engine::picture_size(room.view_size(), quality.scale);
        plan::View view = room.visible();
        view.width = size.width;
        view.height = size.height;
        view.samples = samples_of(engine::Refinement::better);
        scene::Image image;
        plan::FrameStats stats;
        renderer_.render(view, image, stats);
        protocol::FrameHeader header = room::header_of(room.state(), view, room.view_size());
        header.frame = frame;
        header.quality = quality;
        header.quality.samples = view.samples;
        header.timing.render_ms = stats.render_ms;
        std::vector<std::uint8_t> file = jpeg_.encode(image, quality.jpeg_quality, false);
        const std::vector<std::uint8_t> comment = protocol::comment_segment(protocol::encode(header));
        file.insert(file.begin() + static_cast<std::ptrdiff_t>(protocol::comment_offset(file)),
                    comment.begin(), comment.end());
        char name[40];
        std::snprintf(name, sizeof name, "frame-%06lld.jpg", static_cast<long long>(frame));
        base::write_file(folder_ / name, file);
    }

private:
    fs::path folder_;
    renderer::Renderer renderer_;
    engine::JpegEncoder jpeg_;
};

}  // namespace

void replay_command(const ReplayArguments& arguments) {
    const auto log = room::read_event_log(std::ifstream(arguments.log), arguments.log.string());
    if (!log) throw std::runtime_error(log.error());
    if (!log->cut.empty()) observe::log_warning("log_cut_off", {{"reason", log->cut}});
    std::optional<FrameWriter> frames;
    if (!arguments.frames.empty()) frames.emplace(arguments.frames, arguments.device);
    SessionScenes scenes(arguments.log, arguments.scene, arguments.read);
    room::ReplayWatcher watcher;
    if (frames)
        watcher.on_drawn = [&](std::int64_t frame, const room::Room& room) { frames->write(frame, room); };
    const auto finder = [&](const std::string& name, const std::string& sha256,
                            std::optional<protocol::UpAxis> up_axis) {
        return scenes.find(name, sha256, up_axis);
    };
    const auto room = room::replay(*log, finder, watcher);
    if (!room) throw std::runtime_error(arguments.log.string() + ": " + room.error());
    std::cout << protocol::encode(room->state().camera) << std::endl;
}

}  // namespace vrut::server::commands
