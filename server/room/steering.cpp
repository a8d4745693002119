#include "room/steering.hpp"

namespace vrut::server::room {

bool Steering::may_steer(const std::string& client, SessionTime now, bool holder_presses) const {
    return !holder_ || holder_ == client || (!kept_ && !holder_presses && now - last_ >= kQuietHolder);
}

void Steering::steer(const std::string& client, SessionTime now) {
    holder_ = client;
    last_ = now;
}

void Steering::take(const std::string& client, SessionTime now) {
    holder_ = client;
    kept_ = true;
    last_ = now;
}

bool Steering::release(const std::string& client) {
    if (holder_ != client) return false;
    holder_.reset();
    kept_ = false;
    return true;
}

}  // namespace vrut::server::room
