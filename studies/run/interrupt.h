/// Ctrl-C and termination requests, turned into a flag that computations look at.
#pragma once

namespace fingertip::studies {

/// From now on SIGINT and SIGTERM set the flag; a second one ends the program at once.
void watch_for_interrupts();

/// Whether the user has asked the program to stop.
bool interrupted();

}  // namespace fingertip::studies
