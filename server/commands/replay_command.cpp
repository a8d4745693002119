#include <fstream>
#include <iostream>
#include <stdexcept>

#include "base/files.hpp"
#include "commands/commands.hpp"
#include "commands/film.hpp"
#include "commands/image_output.hpp"
#include "commands/room_film.hpp"
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

/// The film's size: as asked for, else that of the log's first view, made even.
engine::PictureSize size_of_film(const ReplayArguments& arguments, const protocol::LogHeader& header) {
    if (arguments.width > 0) return {arguments.width, arguments.height};
    const auto even = [](int side) { return std::max(2, side - side % 2); };
    const engine::PictureSize view = engine::picture_size(header.view, 1);
    return {even(view.width), even(view.height)};
}

/// How many images show the session from its start to its end, or behind it.
std::size_t images_of(const room::EventLog& log, int images_per_second) {
    return images_until(log.lines.empty() ? room::SessionTime(0) : log.lines.back().at, images_per_second);
}

ImageOutput::Options film_options(const ReplayArguments& arguments, const room::EventLog& log) {
    constexpr int kJpegQuality = 90;
    const engine::PictureSize size = size_of_film(arguments, log.header);
    return {arguments.film,
            size.width,
            size.height,
            arguments.fps,
            kJpegQuality,
            images_of(log, arguments.fps),
            true};
}

/// Before anything is read: throws where the film cannot be what the arguments say.
void require_replay_output(const ReplayArguments& arguments) {
    if (arguments.film.empty()) return;
    if (is_film(arguments.film))
        require_film(arguments.film, arguments.width, arguments.height);
    else
        format_of(arguments.film);
}

}  // namespace

void replay_command(const ReplayArguments& arguments) {
    require_replay_output(arguments);
    const auto log = room::read_event_log(std::ifstream(arguments.log), arguments.log.string());
    if (!log) throw std::runtime_error(log.error());
    if (!log->cut.empty()) observe::log_warning("log_cut_off", {{"reason", log->cut}});
    std::optional<FrameWriter> frames;
    if (!arguments.frames.empty()) frames.emplace(arguments.frames, arguments.device);
    std::optional<RoomFilm> film;
    if (!arguments.film.empty())
        film.emplace(film_options(arguments, *log), samples_of(engine::Refinement::better), arguments.device);
    SessionScenes scenes(arguments.log, arguments.scene, arguments.read);
    room::ReplayWatcher watcher;
    if (frames)
        watcher.on_drawn = [&](std::int64_t frame, const room::Room& room) { frames->write(frame, room); };
    if (film)
        watcher.before_line = [&](room::SessionTime at, room::Room& room) { film->draw_until(at, room); };
    const auto finder = [&](const std::string& name, const std::string& sha256,
                            std::optional<protocol::UpAxis> up_axis) {
        return scenes.find(name, sha256, up_axis);
    };
    auto room = room::replay(*log, finder, watcher);
    if (!room) throw std::runtime_error(arguments.log.string() + ": " + room.error());
    const std::string camera = protocol::encode(room->state().camera);
    if (film) film->finish(*room);
    std::cout << camera << std::endl;
}

}  // namespace vrut::server::commands
