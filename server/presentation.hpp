#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clicks.hpp"
#include "gestures.hpp"
#include "keys.hpp"
#include "messages.hpp"
#include "pacing.hpp"
#include "picking.hpp"
#include "scene.hpp"
#include "state.hpp"
#include "steering.hpp"
#include "view.hpp"

namespace vrut {

/// What a client is to be told; it must know `revision` of the state first.
struct Answer {
    std::string client, text;
    std::int64_t revision = 0;
    bool refusal = false;
};

/// The scene, the state and the camera that all clients share, who steers them, and what each message does to
/// them. No thread, no clock, no GL: the same messages in the same order lead to the same camera.
class Presentation {
public:
    Presentation(std::shared_ptr<const PlacedScene> scene, std::vector<std::string> notices);

    void join(const std::string& client, protocol::Role role);
    void leave(const std::string& client);
    /// Any message but `frame`. `arrival` tells how long a holder has been quiet. What is refused changes
    /// nothing, and not who steers either.
    void say(const std::string& client, const protocol::ClientMessage& message, Clock::time_point arrival);

    const PlacedScene& scene() const { return *scene_; }
    const protocol::State& state() const { return state_; }
    /// CSS size of the view.
    const protocol::Resize& view_size() const { return view_size_; }
    /// What is to be seen, but for size and samples.
    const View& visible() const { return visible_; }

    /// The document of the present state. Changes since the last call become one revision, made by
    /// `changed_by`.
    const std::shared_ptr<const protocol::StateDocument>& document();
    /// Who made the newest revision and those before it, down to `changed_by_since()`; empty: the server.
    const std::string& changed_by() const { return changed_by_; }
    std::int64_t changed_by_since() const { return changed_by_since_; }
    /// A frame has been drawn of visible() at view_size(): picks name it.
    void remember(std::int64_t frame);
    /// Answers what a client said that cannot be read.
    void refuse(const std::string& client, const protocol::Error& error);
    std::vector<Answer> take_answers() { return std::exchange(answers_, {}); }

private:
    struct Client {
        protocol::Role role = protocol::Role::view;
        std::optional<protocol::Resize> wanted;
    };
    /// The message in hand.
    struct Said {
        const std::string& client;
        const protocol::ClientMessage& message;
        Clock::time_point arrival;
    };

    void apply(const Said& said, const protocol::Hello& hello);
    void apply(const Said& said, const protocol::FrameGrant& grant);
    void apply(const Said& said, const protocol::Resize& resize);
    void apply(const Said& said, const protocol::Pointer& pointer);
    void apply(const Said& said, const protocol::Wheel& wheel);
    void apply(const Said& said, const protocol::Key& key);
    void apply(const Said& said, const protocol::Patch& patch);
    void apply(const Said& said, const protocol::Navigate& navigate);
    void apply(const Said& said, const protocol::Fit& fit);
    void apply(const Said& said, const protocol::Control& control);
    void apply(const Said& said, const protocol::Pick& pick);

    void answer(const Said& said);

    /// Whether this message may steer; else it is refused.
    bool may_steer(const Said& said);
    /// The message steers: its client holds control.
    void steer(const Said& said);
    void hold(const std::optional<std::string>& holder);
    void use_holders_size();

    /// What a frame showed at a point of its view, and how much of it; none where that frame is not
    /// remembered.
    struct Look {
        std::optional<Hit> hit;
    };
    std::optional<Look> look(double x, double y, std::optional<std::int64_t> frame, bool through) const;
    void apply(Click::Operation operation, const std::optional<Hit>& hit);
    void select(Index node);
    std::vector<std::string> path_of(Index node) const;

    Camera camera() const;
    Camera home() const;
    double aspect() const { return view_size_.width / view_size_.height; }
    NavigationContext navigation_context() const;
    /// From a drag: it goes on from where it began.
    void drag_camera(const Camera& camera);
    /// From anything else: drags begin anew there.
    void move_camera(const Camera& camera);

    std::shared_ptr<const PlacedScene> scene_;
    protocol::Resize view_size_;  // before the state, whose first camera is fitted to it
    protocol::State starting_, state_;
    std::shared_ptr<const protocol::StateDocument> document_;
    std::string changed_by_, changing_;
    std::int64_t changed_by_since_ = 0;
    std::vector<Answer> answers_;
    std::map<std::string, Client> clients_;
    Steering steering_;
    Gestures gestures_;
    Clicks clicks_;
    bool size_waits_ =
        false;  ///< for the press that took control to end: it is measured in the view that it began in
    View visible_;
    struct Frame {
        std::int64_t number = 0;
        Camera camera;
        protocol::Resize view_size;
    };
    std::deque<Frame> frames_;  ///< the last kFramesRemembered
    bool at_home_ = false;      ///< nobody has moved the camera since loading: it follows the view's size
};

}  // namespace vrut
