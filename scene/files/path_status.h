// What lies at a path, and what lies in a folder. "Nothing is there" and "nobody could look" are two answers here. The second
// (no permission, a disk that does not answer, links in a circle) is an Error and is never taken for the first.
// std::filesystem's questions do that when their std::error_code is dropped. tests/project/project_arrows_test.cpp keeps those
// questions in this file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

enum class FileKind : std::uint8_t { none, file, folder, other };

/// What `path` leads to, links followed. `none` is said only where the system says that nothing is there, as at the end of
/// a link that leads nowhere. The error is of the given kind: cannot_write where an output's place is looked at.
Expected<FileKind> file_kind(const std::string& path, ErrorKind error = ErrorKind::bad_input);
/// Answers with one question: whether something is there.
Expected<bool> is_there(const std::string& path, ErrorKind error = ErrorKind::bad_input);
Expected<bool> is_folder(const std::string& path, ErrorKind error = ErrorKind::bad_input);
Expected<bool> is_plain_file(const std::string& path, ErrorKind error = ErrorKind::bad_input);

/// Returns the size of a plain file, bytes; anything else is an error.
Expected<std::uint64_t> size_of_file(const std::string& path, ErrorKind error = ErrorKind::bad_input);

/// Where an answer decides nothing but words or comfort: what could not be looked at counts as nothing.
FileKind file_kind_or_none(const std::string& path);

/// The names of all that lies in the folder, sorted. It is an error when the folder is not there, or cannot be read to its
/// end.
Expected<std::vector<std::string>> names_in(const std::string& folder,
                                            ErrorKind error = ErrorKind::bad_input);
/// Returns the names in a folder that was opened for reading, by its descriptor, which is closed. `folder` is its path for
/// messages.
Expected<std::vector<std::string>> names_in_open(int descriptor, const std::string& folder, ErrorKind error);
/// Lists a folder that need not be there: it holds nothing then.
Expected<std::vector<std::string>> names_if_there(const std::string& folder,
                                                  ErrorKind error = ErrorKind::bad_input);
/// The paths, relative to the folder and sorted, of all files in it and in the folders below it. A link is one of the
/// files; it is not followed.
Expected<std::vector<std::string>> files_below(const std::string& folder,
                                               ErrorKind error = ErrorKind::bad_input);

/// Removes a file, a link or an empty folder; that it is not there is no error. ErrorKind::cannot_write.
Expected<void> remove_path(const std::string& path);
/// Removes a folder with all that is in it; that it is not there is no error. ErrorKind::cannot_write.
Expected<void> remove_all_of(const std::string& folder);

/// Whether both are there and are one file or one folder.
Expected<bool> are_one_path(const std::string& a, const std::string& b,
                            ErrorKind error = ErrorKind::bad_input);

// How a failed call of the system is told.

/// "FILE: STEP: what errno (`error_number`) means", of that kind; or of ErrorKind::graphics, which is for resources, too, where
/// descriptors or memory are what is missing.
tl::unexpected<Error> failed_call(ErrorKind kind, std::string file, std::string_view step, int error_number);

}  // namespace gnomon
