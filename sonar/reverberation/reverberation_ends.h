#pragma once
#include "reverb/pairs/scattering_sheet.h"
#include "sonar/reverberation/reverberation_context.h"

namespace asdic::detail {

/// Source and receiver of one ping, with the ways that they take while it is sent and received.
[[nodiscard]] SheetEnds ends_of(const ReverberationContext& context);

/// Puts the source above the origin, the receiver beside it as it was.
void move_to_source(SheetEnds& ends);

/// How far the receiver gets from where it is at the ping's start [m].
[[nodiscard]] double way_of_receiver(const SheetEnds& ends);

}  // namespace asdic::detail
