#include "commands/room_film.hpp"

#include <algorithm>

#include "commands/film.hpp"

namespace vrut::server::commands {

namespace {

constexpr std::int64_t kSecond = 1'000'000;  // of room::SessionTime

}  // namespace

std::size_t images_until(room::SessionTime end, int images_per_second) {
    const std::int64_t time = std::max<std::int64_t>(end.count(), 0);
    return static_cast<std::size_t>((time * images_per_second + kSecond - 1) / kSecond + 1);
}

RoomFilm::RoomFilm(const ImageOutput::Options& options, int samples, std::optional<int> device)
    : options_(options), samples_(samples), renderer_(device) {
    require_size(options.width, options.height, renderer_);
    output_.emplace(options);
}

void RoomFilm::draw_until(room::SessionTime at, room::Room& room) {
    while (time_of(next_) < at) draw_next(room);
}

void RoomFilm::finish(room::Room& room) {
    draw_next(room);
    output_->finish();
}

room::SessionTime RoomFilm::time_of(std::size_t image) const {
    return room::SessionTime(kSecond * static_cast<std::int64_t>(image) / options_.images_per_second);
}

void RoomFilm::draw_next(room::Room& room) {
    room.advance(time_of(next_++));
    plan::View view = room.visible();
    view.width = options_.width;
    view.height = options_.height;
    view.samples = samples_;
    if (drawn_ == view) return output_->repeat();
    plan::FrameStats stats;
    renderer_.render(view, image_, stats);
    output_->add(image_);
    drawn_ = std::move(view);
}

}  // namespace vrut::server::commands
