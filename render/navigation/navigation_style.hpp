#pragma once

namespace vrut::navigation {

/// Whose mouse the user's hand is used to. Touch and the wheel are the same in all of them.
enum class NavigationStyle { vrut, maya, catia, cinema4d };

/// As W3C numbers them; among those held each has another number, see button_mask().
enum MouseButton { left_button = 0, middle_button = 1, right_button = 2 };
/// Of `PointerEvent.buttons`; 0 for buttons that mean nothing here.
unsigned button_mask(int button);

struct ModifierKeys {
    bool alt = false, ctrl = false, shift = false, meta = false;
};

enum class DragOperation { none, rotate, pan, zoom };

/// How the hand holds a mouse or a pen; it is taken when a drag begins, or begins anew with other buttons.
struct Grip {
    int button = 0;        ///< the held one that was pressed last; -1 where it is not known
    unsigned buttons = 0;  ///< those held
    /// Another button was held together with the middle one, which is still held, and has been released.
    bool after_chord = false;
    ModifierKeys modifiers;
    int number = 0;  ///< the number key held, the newest of several; 0 none
};

/// What a drag does.
DragOperation drag_operation(NavigationStyle style, const Grip& grip);
/// Whether with these keys held the buttons are the camera's alone: a press is the begin of a drag, not of a
/// click.
bool suppresses_clicks(NavigationStyle style, const ModifierKeys& modifiers);

}  // namespace vrut::navigation
