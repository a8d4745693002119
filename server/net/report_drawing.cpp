#include "net/report_drawing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "net/registry.hpp"

namespace vrut::server::net {

namespace {

constexpr int kWidth = 640;  // pixels

/// As wide as all, of the view's shape.
engine::PictureSize size_like(const engine::PictureSize& view, const engine::PictureLimits& limits) {
    engine::PictureSize size{kWidth, kWidth * 9 / 16};
    if (view.width > 0 && view.height > 0)
        size.height =
            std::clamp(static_cast<int>(std::lround(1.0 * kWidth * view.height / view.width)), 1, 2 * kWidth);
    if (!engine::fits(size.width, size.height, limits)) size = view;
    return size;
}

std::int64_t now_ms() {
    const auto since = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
}

class ReportDrawing : public std::enable_shared_from_this<ReportDrawing> {
public:
    ReportDrawing(protocol::ReportedState state, std::shared_ptr<ServedRoom> room, std::size_t& running,
                  std::function<bool()> goes_on, std::function<void(std::optional<std::string>)> done)
        : state_(std::move(state)),
          wanted_(report::pictures_of(state_)),
          room_(std::move(room)),
          document_(room_->document.newest()),
          running_(running),
          goes_on_(std::move(goes_on)),
          done_(std::move(done)) {
        ++running_;
    }
    ~ReportDrawing() { --running_; }
    ReportDrawing(const ReportDrawing&) = delete;
    ReportDrawing& operator=(const ReportDrawing&) = delete;

    void draw_next() {
        if (!goes_on_()) return;
        if (!document_->has_scene_of(*room_->document.newest())) return done_(std::nullopt);
        if (pictures_.size() == wanted_.size() || bytes_ >= report::kMostPictureBytes)
            return done_(report::html(state_, pictures_, now_ms()));
        room_->pictures.draw(
            wanted_[pictures_.size()], size_like(room_->size, room_->engine->limits()),
            [self = shared_from_this()](report::Picture picture) {
                self->bytes_ += picture ? picture->size() : 0;
                self->pictures_.push_back(std::move(picture));
                self->draw_next();
            },
            *room_->engine, room_->suffix);
    }

private:
    protocol::ReportedState state_;
    std::vector<protocol::OtherView> wanted_;
    std::shared_ptr<ServedRoom> room_;
    std::shared_ptr<const protocol::StateDocument> document_;  ///< whose scene the pictures show
    std::size_t& running_;
    std::function<bool()> goes_on_;
    std::function<void(std::optional<std::string>)> done_;
    std::vector<report::Picture> pictures_;
    std::size_t bytes_ = 0;
};

}  // namespace

void draw_report(protocol::ReportedState state, std::shared_ptr<ServedRoom> room, std::size_t& running,
                 std::function<bool()> goes_on, std::function<void(std::optional<std::string> html)> done) {
    std::make_shared<ReportDrawing>(std::move(state), std::move(room), running, std::move(goes_on),
                                    std::move(done))
        ->draw_next();
}

}  // namespace vrut::server::net
