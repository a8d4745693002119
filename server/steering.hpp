#pragma once

#include <optional>
#include <string>

#include "messages.hpp"
#include "pacing.hpp"

namespace vrut {

/// Who steers. A holder who has been quiet for a second, with no pointer pressed, gives way to the next who
/// steers.
class Steering {
public:
    static constexpr std::chrono::milliseconds kQuietHolder{1000};

    /// `client` wants to steer. True where it holds control now, perhaps since just now.
    bool steer(const std::string& client, Clock::time_point now, bool holder_presses);
    /// `client` is gone. True where it held control.
    bool leave(const std::string& client);
    const std::optional<std::string>& holder() const { return holder_; }

private:
    std::optional<std::string> holder_;
    Clock::time_point last_;
};

}  // namespace vrut
