#include "engine/fair_queue.hpp"

namespace vrut::server::engine {

namespace {

/// "" where it is of none.
std::string client_of(const EngineEvent& event) {
    return std::visit(
        [](const auto& what) {
            if constexpr (requires { what.client; })
                return what.client;
            else
                return std::string();
        },
        event);
}

}  // namespace

void FairQueue::push(EngineEvent event) {
    std::deque<EngineEvent>& events = events_[client_of(event)];
    if (std::holds_alternative<ClientLeft>(event))
        size_ -= std::erase_if(events, [](const EngineEvent& waiting) {
            return !std::holds_alternative<ClientJoined>(waiting);
        });
    events.push_back(std::move(event));
    ++size_;
}

EngineEvent FairQueue::pop() {
    auto next = events_.upper_bound(last_);
    if (next == events_.end()) next = events_.begin();
    last_ = next->first;
    EngineEvent event = std::move(next->second.front());
    next->second.pop_front();
    --size_;
    if (next->second.empty()) events_.erase(next);
    return event;
}

}  // namespace vrut::server::engine
