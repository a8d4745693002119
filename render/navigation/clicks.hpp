#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gestures.hpp"

namespace vrut {

/// One client's time in ms, from its events' own time stamps where they can be trusted: a link that delays
/// events must not turn two clicks into a double one, or a double one into two. Where a stamp is absent,
/// falls, or departs from the arrival by more than a second, the arrival counts.
class EventClock {
public:
    /// Time of an event since the first; never falls as long as `arrival` does not. Both in ms.
    double time(std::optional<double> time_stamp, double arrival);

private:
    bool started_ = false;
    std::optional<double> last_stamp_;
    double last_arrival_ = 0, time_ = 0;
};

/// What a click asks for, to be done with what is hit at the point.
struct Click {
    enum class Operation { select, set_center, look_at };
    Operation operation = Operation::select;
    double x = 0, y = 0;  ///< CSS pixels
};

/// Double clicks, double taps, and a second finger that taps while the first rests. Pure: time comes with the
/// input.
class Clicks {
public:
    static constexpr double kLongest = 250;     ///< ms from press to release
    static constexpr double kFarthest = 10;     ///< CSS pixels that a click may move
    static constexpr double kNextWithin = 400;  ///< ms from the first press to the second
    static constexpr double kNextNear = 24;     ///< CSS pixels between them

    /// What `input`, at `time` ms of its client's clock, completes.
    std::optional<Click> pointer(const PointerInput& input, double time);
    void lift(const std::string& client);
    bool is_pressed(const std::string& client, std::int64_t pointer) const;

private:
    struct Press {
        std::string client;
        std::int64_t pointer = 0;
        PointerInput::Device device = PointerInput::Device::mouse;
        int button = 0;
        glm::dvec2 place{0};
        double time = 0;
        bool moved = false;
    };
    std::optional<Click> released(const Press& press, double time);

    std::vector<Press> pressed_;  // in the order of pressing
    std::optional<Press> last_;   // the last click, until a second follows it
};

}  // namespace vrut
