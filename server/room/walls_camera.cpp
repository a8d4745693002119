#include "room/walls_camera.hpp"

#include <algorithm>
#include <cmath>

#include "room/scene_state.hpp"

namespace vrut::server::room {

namespace {

constexpr SessionTime kStep{16'000};
static_assert(navigation::ComfortLimiter::kStep == 0.016);

}  // namespace

void WallsCamera::use(bool limited, bool moves, const scene::Camera& room, SessionTime now) {
    if (!limited) return following_.reset();
    if (!following_) following_.emplace(Following{navigation::ComfortLimiter(room)});
    if (!moves && following_->limiter.rests_at(room))
        following_->due.reset();
    else if (!following_->due)
        following_->due = now + kStep;
}

std::optional<SessionTime> WallsCamera::due() const { return following_ ? following_->due : std::nullopt; }

void WallsCamera::step(const scene::Camera& room, const protocol::ComfortState& comfort, double metres) {
    following_->limiter.step(
        room, {comfort.degrees_per_second, comfort.degrees_per_second_squared,
               comfort.metres_per_second / metres, comfort.metres_per_second_squared / metres});
    *following_->due += kStep;
}

std::optional<protocol::WallsState> WallsCamera::state(const scene::Camera& room, const math::Bounds& bounds,
                                                       double metres) const {
    if (!following_ || following_->limiter.pose() == room) return std::nullopt;
    const scene::Camera& pose = following_->limiter.pose();
    const navigation::Behind behind = navigation::behind(pose, room);
    const scene::ClipRange range = scene::fit_clip_range(pose, bounds);
    return protocol::WallsState{pose_of(pose), range.near, range.far, std::min(behind.degrees, 180.0),
                                behind.units * metres};
}

std::optional<protocol::LogHeader::Walls> WallsCamera::logged(SessionTime now) const {
    if (!due()) return std::nullopt;
    const navigation::ComfortLimiter::Motion& motion = following_->limiter.motion();
    return protocol::LogHeader::Walls{protocol::ViewState{pose_of(motion.pose), {}},
                                      protocol::ViewState{pose_of(motion.guide), {}}, motion.velocity,
                                      motion.spin, static_cast<double>((*due() - now).count()) / 1000};
}

std::optional<protocol::Error> WallsCamera::restore(const protocol::LogHeader::Walls& walls,
                                                    SessionTime now) {
    const navigation::ComfortLimiter::Motion motion{camera_of(walls.camera), camera_of(walls.guide),
                                                    walls.velocity, walls.spin};
    for (const scene::Camera& camera : {motion.pose, motion.guide})
        if (!scene::is_valid_pose(camera, 0))
            return protocol::Error{
                {},
                protocol::error_code::out_of_range,
                "'walls': eye and focus must be apart, and up neither zero nor along the view"};
    if (following_)
        following_ =
            Following{navigation::ComfortLimiter(motion), now + SessionTime(std::llround(walls.due * 1000))};
    return std::nullopt;
}

}  // namespace vrut::server::room
