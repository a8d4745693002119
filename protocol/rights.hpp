#pragma once

#include "messages.hpp"

namespace vrut::protocol {

enum class Right {
    look,     ///< get frames and the state, and ask about the scene
    present,  ///< be one of those who show: patch, keep a place on a full server, be listed without a name
    hold_control,  ///< be the one who steers, and point whoever may point
    drive_walls,   ///< have the camera of the walls, tell what they show, and move what hosts may move
};

/// Who may do what: nothing else compares roles.
constexpr bool may(Role role, Right right) {
    struct Rights {
        bool look, present, hold_control, drive_walls;
    };
    // clang-format off
    //                         look  present hold_control drive_walls
    constexpr Rights kControl{ true, true,   true,        false };
    constexpr Rights kView{    true, false,  false,       false };
    constexpr Rights kHost{    true, true,   false,       true  };
    // clang-format on
    const Rights& rights = role == Role::control ? kControl : role == Role::host ? kHost : kView;
    switch (right) {
        case Right::look:
            return rights.look;
        case Right::present:
            return rights.present;
        case Right::hold_control:
            return rights.hold_control;
        case Right::drive_walls:
            return rights.drive_walls;
    }
    return false;
}

}  // namespace vrut::protocol
