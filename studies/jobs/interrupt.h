/// Ctrl-C and termination requests, turned into a flag that computations look at.
#pragma once

namespace fingertip::studies::inline jobs {

/// From now on SIGINT and SIGTERM set the flag; a second one ends the program at once.
void watch_for_interrupts();

/// Hands both signals back to whom they belonged before, and forgets the flag: for a program that
/// goes on after a run, as Python does.
void stop_watching();

/// Whether the user has asked the program to stop.
bool interrupted();

}  // namespace fingertip::studies::inline jobs
