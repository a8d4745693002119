#include "room/input_rules.hpp"

#include "codec.hpp"
#include "navigation/gestures.hpp"
#include "navigation/keys.hpp"

namespace vrut::server::room {

namespace {

const char* name_of(navigation::DragOperation operation) {
    switch (operation) {
        case navigation::DragOperation::rotate:
            return "rotate";
        case navigation::DragOperation::pan:
            return "pan";
        case navigation::DragOperation::zoom:
            return "zoom";
        case navigation::DragOperation::none:
            break;
    }
    return "none";
}

}  // namespace

protocol::InputRules input_rules() {
    const auto& steps = navigation::kWheelSteps;
    protocol::InputRules rules{
        {steps[0], steps[1], steps[2]}, navigation::kWheelZoom, navigation::kDragZoom, {}, {}, {}};
    for (const navigation::PlainDrag& drag : navigation::plain_drags()) {
        const char* style = protocol::name_of(static_cast<protocol::NavigationState::Style>(drag.style));
        rules.drags[style][std::to_string(drag.buttons)] = name_of(drag.operation);
    }
    for (const navigation::KeyName& name : navigation::key_names()) {
        rules.keys.emplace_back(name.key);
        if (name.repeats) rules.repeating_keys.emplace_back(name.key);
    }
    return rules;
}

}  // namespace vrut::server::room
