#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "navigation/gestures.hpp"

namespace vrut::navigation {

/// When an event happened.
struct EventTime {
    std::optional<double> stamp;           ///< `Event.timeStamp`: ms of its client's clock, within ±10¹⁵
    std::chrono::microseconds arrival{0};  ///< by the server's clock, from any start
};

/// Clock of one client. Uses the events' own time stamps, so that link delay neither makes nor breaks a
/// double click; falls back to arrival times where a stamp is missing, decreases, or differs from the arrival
/// by more than a second. Whole microseconds, so that sums are exact.
class EventClock {
public:
    /// Time of an event since the first; never falls as long as the arrivals do not.
    std::chrono::microseconds time(const EventTime& event);

private:
    std::optional<EventTime> last_;
    std::chrono::microseconds time_{0};
};

/// The operation that a click requests on the object hit at its position.
struct Click {
    enum class Operation { select, set_center, look_at };
    Operation operation = Operation::select;
    double x = 0, y = 0;  ///< CSS pixels
};

/// Double clicks, double taps, and a second finger that taps while the first rests. Only presses, releases
/// and chords count, and where a pointer is when one comes: moves between may be merged as for Gestures.
class Clicks {
public:
    static constexpr std::chrono::milliseconds kLongest{250};     ///< from press to release
    static constexpr double kFarthest = 10;                       ///< CSS pixels between them
    static constexpr std::chrono::milliseconds kNextWithin{400};  ///< from the first press to the second
    static constexpr double kNextNear = 24;                       ///< CSS pixels between them

    /// Returns the click that `input` completes, if any.
    std::optional<Click> pointer(const PointerInput& input, const EventTime& when,
                                 NavigationStyle style = NavigationStyle::vrut);
    /// Where the last release completed a click, by touch or the left button, that may become a double one.
    std::optional<glm::dvec2> tap() const;
    void lift(const std::string& client);
    bool is_pressed(const std::string& client, std::int64_t pointer) const;

private:
    struct Press {
        std::string client;
        std::int64_t pointer = 0;
        PointerInput::Device device = PointerInput::Device::mouse;
        int button = 0;
        glm::dvec2 place{0}, now{0};
        std::chrono::microseconds time{0};
        bool clicks = true;  ///< else a drag: the camera's, or one of two buttons

        bool stays() const { return clicks && glm::distance(now, place) <= kFarthest; }
    };
    void press(const PointerInput& input, const EventTime& when, NavigationStyle style);
    std::optional<Click> released(const Press& press, std::chrono::microseconds time);

    std::map<std::string, EventClock> clocks_;  // by client; asked for presses and releases only
    std::vector<Press> pressed_;                // in the order of pressing
    std::optional<Press> last_;                 // the last click, until a second follows it
};

}  // namespace vrut::navigation
