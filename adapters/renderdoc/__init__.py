"""The package as an extension of qrenderdoc: Tools, Judge this frame writes the capture's folder for `gnomon judge`.

Copied as a whole to qrenderdoc's extensions/gnomon. The way for frames that replay on another system alone, as Direct3D's do.
"""
import qrenderdoc

from .gnomon_frame import cli
from .gnomon_frame.errors import FrameError


def _make_capture(context, folder):
    """What there is to say once the capture is written; runs in the replay's own thread."""
    said = []

    def replay(controller):
        try:
            from .gnomon_frame.replay import Frame

            words = [context.GetCaptureFilename(), "--output", folder]
            said.append("gnomon judge " + cli.run(Frame(controller), cli.arguments(words), said.append))
        except FrameError as error:
            said.append(str(error))
        except ImportError as error:
            said.append(f"{error}: this Python needs NumPy")

    context.Replay().BlockInvoke(replay)
    return "\n".join(said)


def _judge(context, _data):
    extensions = context.Extensions()
    if not context.IsCaptureLoaded():
        extensions.ErrorDialog("Open a frame first.", "Judge this frame")
        return
    folder = extensions.OpenDirectoryName("A folder for the capture", "", "")
    if folder:
        extensions.MessageDialog(_make_capture(context, folder), "Judge this frame")
        context.SetEventID([], context.CurSelectedEvent(), context.CurEvent(), True)  # the replay went elsewhere


def register(_version, context):
    """Called by qrenderdoc when the extension is switched on."""
    context.Extensions().RegisterWindowMenu(qrenderdoc.WindowMenu.Tools, ["Judge this frame"], _judge)


def unregister():
    """Called by qrenderdoc when it is switched off; the menu is qrenderdoc's to take away."""
