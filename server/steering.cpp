#include "steering.hpp"

namespace vrut {

bool Steering::steer(const std::string& client, Clock::time_point now, bool holder_presses) {
    const bool free = !holder_ || (!holder_presses && now - last_ >= kQuietHolder);
    if (holder_ != client && !free) return false;
    holder_ = client;
    last_ = now;
    return true;
}

bool Steering::leave(const std::string& client) {
    if (holder_ != client) return false;
    holder_.reset();
    return true;
}

}  // namespace vrut
