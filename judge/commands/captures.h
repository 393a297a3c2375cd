// What the words of `gnomon judge` name: captures of files, folders and options, and those made of recorded frames.
#pragma once

#include <string>
#include <vector>

#include "app/console.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "judge/commands/judge_options.h"

namespace gnomon::app {

/// One of several: a light of a capture, or why the capture cannot be read.
struct NamedCapture {
  std::string name;  ///< no two have one name
  Expected<judge::Capture> capture;
};

/// A capture's lights, each with the options' parts in place of its own; of several the options' light chooses one. Without a
/// path the options alone say it. Errors (bad input, usage) name the field or the option.
Expected<std::vector<judge::Capture>> lights_of(const CaptureOptions& options, const std::string& path);

/// The lights of all captures; those of a capture of several are called by it and the light.
std::vector<NamedCapture> all_lights(const std::vector<std::string>& captures, const CaptureOptions& options);

/// The files that a capture names, its own among them.
RunFiles inputs_of(const judge::Capture& capture);

/// "wall" of wall/capture.json, "wall" of wall.json; "town" of http://localhost/town.html, "localhost" of http://localhost/.
std::string name_of(const std::string& path);

/// Every capture.json of a folder and of those directly below it, by name; an error (bad input) where there is none.
Expected<std::vector<std::string>> captures_below(const std::string& folder);

/// Where the frame of a page is recorded; it goes with this.
class PageFrame {
 public:
  std::string renderer{};  ///< the engine, else the page
  std::string path() const { return folder_.path() + "/frame.rdc"; }

 private:
  TemporaryFolder folder_{"gnomon-page"};
};

/// Records a page's first frame with shadows; what is done and waited for is said.
Expected<void> record_frame(const std::string& page, PageFrame& frame, Console& console);

/// Makes captures of all recorded frames and pages among `captures` and puts them in their place. They lie beside their verdicts in
/// `folder`. Where that is empty it gets its default: "wall-capture" of "wall", "walls-captures/a" of "walls/a". `alone`: no
/// others are judged beside them. The options' light is then a frame's, counted from 1, and taken away.
Expected<void> make_captures(std::vector<std::string>& captures, bool alone, CaptureOptions& options,
                             std::string& folder, Console& console);

}  // namespace gnomon::app
