#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace vrut::server::room {

/// Time since the server started, or since a recording began.
using SessionTime = std::chrono::microseconds;

/// Who steers. A holder who has been quiet for a second, with no pointer pressed, gives way to the next who
/// steers.
class Steering {
public:
    static constexpr std::chrono::milliseconds kQuietHolder{1000};

    Steering() = default;
    /// As it stood at `now`, when `holder` steered last.
    Steering(std::optional<std::string> holder, bool kept, SessionTime now)
        : holder_(std::move(holder)), kept_(kept), last_(now) {}

    /// Returns true if `client` may steer at `now`: it holds control, or nobody does, or the holder gives
    /// way.
    bool may_steer(const std::string& client, SessionTime now, bool holder_presses) const;
    /// `client`, who may, steers: it holds control from now on.
    void steer(const std::string& client, SessionTime now);
    /// `client` takes control and keeps it, however quiet it is, until it gives it back or another takes it.
    void take(const std::string& client, SessionTime now);
    /// `client` gives control back, or is gone. True where it held control; nobody inherits.
    bool release(const std::string& client);
    const std::optional<std::string>& holder() const { return holder_; }
    bool kept() const { return kept_; }

    bool operator==(const Steering&) const = default;

private:
    std::optional<std::string> holder_;
    bool kept_ = false;
    SessionTime last_{0};
};

}  // namespace vrut::server::room
