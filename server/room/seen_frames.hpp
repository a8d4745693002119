#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>

#include "mesh/picking.hpp"
#include "messages.hpp"
#include "scene/camera.hpp"

namespace vrut::server::room {

/// What the view showed, or shows.
struct SeenFrame {
    std::int64_t number = 0;  ///< 0: it is no frame
    scene::Camera camera;
    protocol::Resize view_size;

    /// From its eye through a point of its view, in CSS pixels.
    mesh::Ray ray_at(double x, double y) const {
        const glm::dvec2 point(2 * x / view_size.width - 1, 2 * y / view_size.height - 1);
        return {camera.eye, scene::direction_through(camera, view_size.width / view_size.height, point)};
    }
};

/// The last frames that were drawn of the view: picks may name them.
class SeenFrames {
public:
    static constexpr std::size_t kMost = 64;

    void add(const SeenFrame& frame) {
        frames_.push_back(frame);
        if (frames_.size() > kMost) frames_.pop_front();
    }
    /// Null where it is not remembered.
    const SeenFrame* find(std::int64_t number) const {
        const auto found = std::ranges::find(frames_, number, &SeenFrame::number);
        return found == frames_.end() ? nullptr : &*found;
    }
    /// Null where there was none.
    const SeenFrame* newest() const { return frames_.empty() ? nullptr : &frames_.back(); }
    /// The oldest first.
    const std::deque<SeenFrame>& all() const { return frames_; }

private:
    std::deque<SeenFrame> frames_;
};

}  // namespace vrut::server::room
