#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "room/steering.hpp"
#include "scene/scene.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// Doors, bonnets and lids on their way about their hinges, and the tap that may set one off.
class Swings {
public:
    using Nodes = std::map<std::string, protocol::NodeOverride>;

    bool empty() const { return swings_.empty(); }
    /// `node` has a hinge. `open`: how far it goes, from 0 to 1; none: closed, or else open. `ms`: from one
    /// end to the other.
    void begin(const scene::PlacedScene& placed, scene::Index node, std::optional<double> open, double ms,
               SessionTime start);
    /// From where `node` stands in `ms`, whatever way it is.
    void begin_at(scene::Index node, double from, double to, double ms, SessionTime start) {
        swings_.push_back({node, from, to, start, ms});
    }
    /// Brings `nodes` to where they are at `now`; what has arrived is on its way no more.
    void advance(const scene::Scene& scene, SessionTime now, Nodes& nodes);
    /// At the next advance() all have arrived.
    void hurry();
    /// Those end to which `next` gives another matrix than `before`.
    void end_changed(const scene::Scene& scene, const Nodes& before, const Nodes& next);
    void clear() { swings_.clear(); }
    /// For the state.
    std::map<std::string, protocol::SwingState> states(const scene::Scene& scene) const;

    /// A tap on `node`, which has a hinge: it may still become a double one until `due`.
    void tap(scene::Index node, SessionTime due) { tap_ = {node, due}; }
    bool is_tapped() const { return tap_.has_value(); }
    std::optional<SessionTime> tap_due() const { return tap_ ? std::optional(tap_->due) : std::nullopt; }
    void forget_tap() { tap_.reset(); }
    /// Sets off what was tapped, where that is a single tap by now.
    void use_tap(const scene::PlacedScene& placed, SessionTime now);

private:
    struct Swing {
        scene::Index node = scene::kNone;
        double from = 0, to = 1;  ///< parts of the hinge's degrees
        SessionTime start{0};
        double ms = 0;
        double part_at(SessionTime time) const;
    };
    struct Tap {
        scene::Index node = scene::kNone;
        SessionTime due{0};
    };

    std::vector<Swing> swings_;
    std::optional<Tap> tap_;
};

}  // namespace vrut::server::room
