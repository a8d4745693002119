#pragma once

#include <vector>

namespace vrut::navigation {

/// The program whose mouse bindings are used. Touch and wheel are the same in all styles.
enum class NavigationStyle { vrut, maya, catia, cinema4d };

/// `PointerEvent.button`; `buttons` has other values, see button_mask().
enum MouseButton { left_button = 0, middle_button = 1, right_button = 2 };
/// The bit of a button in `PointerEvent.buttons`; 0 for buttons without a binding.
unsigned button_mask(int button);

struct ModifierKeys {
    bool alt = false, ctrl = false, shift = false, meta = false;
};

enum class DragOperation { none, rotate, pan, zoom };

/// The buttons and keys held; sampled when a drag starts, or restarts with other buttons.
struct Grip {
    int button = 0;        ///< the held one that was pressed last; -1 where it is not known
    unsigned buttons = 0;  ///< those held
    /// Another button was held together with the middle one, which is still held, and has been released.
    bool after_chord = false;
    ModifierKeys modifiers;
    int number = 0;  ///< the number key held, the newest of several; 0 none
};

/// A drag that needs no key, by a single button.
struct PlainDrag {
    NavigationStyle style = NavigationStyle::vrut;
    unsigned buttons = 0;  ///< as `PointerEvent.buttons`
    DragOperation operation = DragOperation::none;
};
std::vector<PlainDrag> plain_drags();
/// Returns the operation of a drag.
DragOperation drag_operation(NavigationStyle style, const Grip& grip);
/// Returns true if, with these keys held, a press starts a drag and never a click.
bool suppresses_clicks(NavigationStyle style, const ModifierKeys& modifiers);

}  // namespace vrut::navigation
