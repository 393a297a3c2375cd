// One process that carries out command after command, which saves whoever needs many of them the starts.
#pragma once

namespace gnomon {

/// The program's only word where its commands come on stdin. Each is its words without the program's name, every word
/// followed by a zero byte, and an empty word. When a command has ended, its exit code follows on stdout as one byte;
/// nothing else is written there. Messages stand on stderr before that byte comes. Files are not flushed
/// to the disk. The times that a run's stages took are then those since the process was started.
inline constexpr const char* commands_from_stdin = "--commands-from-stdin";

}  // namespace gnomon
