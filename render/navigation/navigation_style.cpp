#include "navigation/navigation_style.hpp"

#include <algorithm>
#include <iterator>

namespace vrut::navigation {

namespace {

using Style = NavigationStyle;

/// Which of the held buttons count.
enum class Chord {
    last,         ///< the row's button is the one pressed last, whatever else is held
    alone,        ///< it is the only one
    with_other,   ///< it is held together with another
    after_other,  ///< it is the only one again
};

struct DragRow {
    Style style;
    int button;
    bool alt;    ///< only while Alt is held
    int number;  ///< only while this number key is held; 0 always
    Chord chord;
    DragOperation operation;
};

// The first row that applies says what a drag does; none: nothing. Buttons and keys are those of the
// programs' manuals: Maya's camera tools (tumble, track, dolly), CATIA V5's mouse (FreeCAD's "CAD" style is
// the same), and Cinema 4D's navigation hotkeys (1 move, 2 scale, 3 rotate; orbit, pan, dolly with Alt). How
// far a drag goes is the same in all styles; Maya and Cinema 4D also count the horizontal part when zooming,
// which is left out.
constexpr DragRow kDragRows[] = {
    {Style::vrut, left_button, false, 0, Chord::last, DragOperation::rotate},
    {Style::vrut, right_button, false, 0, Chord::last, DragOperation::pan},
    {Style::vrut, middle_button, false, 0, Chord::last, DragOperation::zoom},

    {Style::maya, left_button, true, 0, Chord::last, DragOperation::rotate},
    {Style::maya, middle_button, true, 0, Chord::last, DragOperation::pan},
    {Style::maya, right_button, true, 0, Chord::last, DragOperation::zoom},

    {Style::catia, middle_button, false, 0, Chord::alone, DragOperation::pan},
    {Style::catia, middle_button, false, 0, Chord::with_other, DragOperation::rotate},
    {Style::catia, middle_button, false, 0, Chord::after_other, DragOperation::zoom},

    {Style::cinema4d, left_button, true, 0, Chord::last, DragOperation::rotate},
    {Style::cinema4d, middle_button, true, 0, Chord::last, DragOperation::pan},
    {Style::cinema4d, right_button, true, 0, Chord::last, DragOperation::zoom},
    {Style::cinema4d, left_button, false, 1, Chord::last, DragOperation::pan},
    {Style::cinema4d, left_button, false, 2, Chord::last, DragOperation::zoom},
    {Style::cinema4d, left_button, false, 3, Chord::last, DragOperation::rotate},
};

bool is_held(Chord chord, int button, const Grip& grip) {
    if (chord == Chord::last) return grip.button == button;
    const unsigned held =
        grip.buttons & (button_mask(left_button) | button_mask(middle_button) | button_mask(right_button));
    if (!(held & button_mask(button))) return false;
    if (chord == Chord::with_other) return held != button_mask(button);
    return held == button_mask(button) && grip.after_chord == (chord == Chord::after_other);
}

}  // namespace

unsigned button_mask(int button) {
    switch (button) {
        case left_button:
            return 1;
        case right_button:
            return 2;
        case middle_button:
            return 4;
        default:
            return 0;
    }
}

std::vector<PlainDrag> plain_drags() {
    std::vector<PlainDrag> drags;
    for (const DragRow& row : kDragRows)
        if (!row.alt && row.number == 0 && row.chord == Chord::last)
            drags.push_back({row.style, button_mask(row.button), row.operation});
    return drags;
}

DragOperation drag_operation(NavigationStyle style, const Grip& grip) {
    const auto* row = std::find_if(std::begin(kDragRows), std::end(kDragRows), [&](const DragRow& candidate) {
        return candidate.style == style && (!candidate.alt || grip.modifiers.alt) &&
               (candidate.number == 0 || candidate.number == grip.number) &&
               is_held(candidate.chord, candidate.button, grip);
    });
    return row == std::end(kDragRows) ? DragOperation::none : row->operation;
}

bool suppresses_clicks(NavigationStyle style, const ModifierKeys& modifiers) {
    return modifiers.alt && std::any_of(std::begin(kDragRows), std::end(kDragRows),
                                        [&](const DragRow& row) { return row.style == style && row.alt; });
}

}  // namespace vrut::navigation
