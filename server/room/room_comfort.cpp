// The camera of hosts, who stand in the picture: it follows the room's at bearable speeds.
#include <algorithm>
#include <cmath>

#include "room/room.hpp"

namespace vrut::server::room {

namespace {

constexpr SessionTime kWallsStep{16'000};
static_assert(navigation::ComfortLimiter::kStep == 0.016);

navigation::ComfortLimits limits_of(const protocol::State& state) {
    const protocol::ComfortState& comfort = state.comfort;
    const double metres = state.unit.metres;
    return {comfort.degrees_per_second, comfort.degrees_per_second_squared,
            comfort.metres_per_second / metres, comfort.metres_per_second_squared / metres};
}

}  // namespace

// It begins to step at what makes it move, and not at a clock's ticks: a log may begin at any time.
void Room::use_walls() {
    const bool is_limited = state_.comfort.on && std::ranges::any_of(clients_, [](const auto& entry) {
                                return may(entry.second.role, protocol::Right::drive_walls);
                            });
    if (!is_limited) return walls_.reset();
    if (!walls_) walls_.emplace(Walls{navigation::ComfortLimiter(camera())});
    if (!moves() && !tap_ && walls_->limiter.rests_at(camera()))
        walls_->due.reset();
    else if (!walls_->due)
        walls_->due = time_ + kWallsStep;
}

void Room::step_walls() {
    if (!changing_.empty()) document();
    changing_.clear();  // how it follows is nobody's doing
    walls_->limiter.step(camera(), limits_of(state_));
    *walls_->due += kWallsStep;
    use_walls();
}

void Room::jump_walls() {
    walls_.reset();
    use_walls();
}

std::optional<protocol::LogHeader::Walls> Room::logged_walls() const {
    if (!walls_ || !walls_->due) return std::nullopt;
    const navigation::ComfortLimiter::Motion& motion = walls_->limiter.motion();
    return protocol::LogHeader::Walls{
        protocol::ViewState{pose_of(motion.pose), {}}, protocol::ViewState{pose_of(motion.guide), {}},
        motion.velocity, motion.spin, static_cast<double>((*walls_->due - time_).count()) / 1000};
}

std::optional<protocol::Error> Room::restore_walls(const protocol::LogHeader::Walls& walls) {
    const navigation::ComfortLimiter::Motion motion{camera_of(walls.camera), camera_of(walls.guide),
                                                    walls.velocity, walls.spin};
    for (const scene::Camera& camera : {motion.pose, motion.guide})
        if (!scene::is_valid_pose(camera, 0))
            return protocol::Error{
                {},
                protocol::error_code::out_of_range,
                "'walls': eye and focus must be apart, and up neither zero nor along the view"};
    if (walls_)
        walls_ =
            Walls{navigation::ComfortLimiter(motion), time_ + SessionTime(std::llround(walls.due * 1000))};
    return std::nullopt;
}

std::optional<protocol::WallsState> Room::walls_state() const {
    if (!walls_ || walls_->limiter.pose() == camera()) return std::nullopt;
    const scene::Camera& pose = walls_->limiter.pose();
    const navigation::Behind behind = navigation::behind(pose, camera());
    const scene::ClipRange range = scene::fit_clip_range(pose, scene_->bounds);
    return protocol::WallsState{pose_of(pose), range.near, range.far, std::min(behind.degrees, 180.0),
                                behind.units * state_.unit.metres};
}

}  // namespace vrut::server::room
