"""A recorded frame, replayed: all that this package asks of RenderDoc's own module, `renderdoc`.

Written for RenderDoc 1.24, which Debian 12 has, on OpenGL and Vulkan; what Direct3D and the bindings of later versions need is
here as well, and has not been run. Events and resources are plain integers outside of this file.
"""
import os
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace

import numpy as np
import renderdoc as rd

from . import conventions, formats, literals, spirv, stand_ins
from .errors import FrameError


class NoDisplay(FrameError):
    """OpenGL is replayed on a display of X11, and there is none."""


@dataclass(frozen=True)
class Texture:
    id: int
    width: int
    height: int
    slices: int
    samples: int
    format: str

    @property
    def is_depth(self):
        return self.format.startswith("D") and self.format[1:2].isdigit()


@dataclass(frozen=True)
class Draw:
    event: int
    name: str
    vertices: int
    instances: int
    colours: tuple  # textures drawn into
    depth: int  # the depth texture drawn into, or 0
    range: tuple = ()  # which part of its buffers it draws


@dataclass
class Mesh:
    """What one draw call made of one instance."""

    event: int
    clip: np.ndarray  # [vertices, 4], each vertex once
    objects: np.ndarray | None  # the same vertices before the shader, 32-bit floats, where an attribute of three floats tells
    corners: np.ndarray  # three vertices for each triangle
    source: tuple  # equal for the same vertices in the same order, whichever shader moved them
    name: str = ""  # the draw's event, which qrenderdoc shows, and the instance
    layer: int | None = None  # of the texture, where a geometry shader chose it
    normals: np.ndarray | None = None  # of the same vertices before the shader, where an attribute that is called so tells


@dataclass
class State:
    """The pipeline as it is at a draw."""

    viewport: tuple  # x, y, width, height, texels; y from the row that the API counts first
    colours: list
    depth: int
    slice: int
    conventions: conventions.Conventions
    reversed: bool  # nearer is a larger number
    writes_depth: bool = True
    depth_bias: dict = field(default_factory=dict)  # constant, slope, clamp as the API has them
    shaders: dict = field(default_factory=dict)  # stage -> id
    side: int = 0  # of which triangles are drawn: 1 those whose corners turn to the left with x to the right and y up in clip space, -1 the others


def _actions(roots):
    for action in roots:
        if action.flags & rd.ActionFlags.Drawcall:
            yield action
        yield from _actions(action.children)


class Frame:
    """A frame under replay. `with Frame.open(path) as frame` replays a file here; Frame(controller) works in qrenderdoc's own."""

    def __init__(self, controller):
        self.controller = controller
        self._ids = {int(t.resourceId): t.resourceId for t in controller.GetTextures()}
        self.textures = {int(t.resourceId): Texture(int(t.resourceId), t.width, t.height, max(t.arraysize, t.depth), t.msSamp, t.format.Name())
                         for t in controller.GetTextures()}
        names = controller.GetStructuredFile()
        self._actions = {a.eventId: a for a in _actions(controller.GetRootActions())}
        self.draws = [Draw(a.eventId, a.GetName(names), a.numIndices, max(1, a.numInstances),
                           tuple(int(o) for o in a.outputs if int(o)), int(a.depthOut),
                           (a.numIndices, a.numInstances, a.indexOffset, a.vertexOffset, a.baseVertex, a.instanceOffset)) for a in self._actions.values()]
        self._event = None
        self._states, self._code = {}, {}
        self.draws = [self._with_targets(draw) for draw in self.draws]

    def _with_targets(self, draw):
        """Draws into a window's own pictures come without their targets on Vulkan."""
        if draw.colours or draw.depth:
            return draw
        state = self.state(draw.event)
        return replace(draw, colours=tuple(state.colours), depth=state.depth)

    @classmethod
    @contextmanager
    def open(cls, path):
        rd.InitialiseReplay(rd.GlobalEnvironment(), [])
        file = rd.OpenCaptureFile()
        try:
            opened = file.OpenFile(path, "", None)
            if opened != rd.ResultCode.Succeeded:
                raise FrameError(f"{path} is no frame that RenderDoc {rd.GetVersionString()} can read: {opened.Message()}")
            if file.LocalReplaySupport() != rd.ReplaySupport.Supported:
                raise FrameError(f"{path} was recorded with {file.DriverName()}, which cannot be replayed on this system: "
                                 "open it in qrenderdoc where it was recorded")
            if file.DriverName() == "OpenGL" and os.name == "posix" and not os.environ.get("DISPLAY"):
                raise NoDisplay("frames of OpenGL are replayed on a display, and DISPLAY names none (Debian: apt install xvfb)")
            status, controller = file.OpenCapture(rd.ReplayOptions(), None)
            if status != rd.ResultCode.Succeeded:
                raise FrameError(f"{path} cannot be replayed here: {status.Message()}")
            try:
                yield cls(controller)
            finally:
                controller.Shutdown()
        finally:
            file.Shutdown()
            rd.ShutdownReplay()

    # --- Which draw does what -------------------------------------------------------------------------------------

    def readers_of(self, texture):
        """Events of draws whose fragments read a texture, in their order."""
        return [u.eventId for u in self.controller.GetUsage(self._ids[texture])
                if u.usage in (rd.ResourceUsage.PS_Resource, rd.ResourceUsage.All_Resource) and u.eventId in self._actions]

    def is_copied_to(self, texture):
        """Whether something copies, resolves or blits into a texture."""
        written = (rd.ResourceUsage.CopyDst, rd.ResourceUsage.ResolveDst)
        return any(u.usage in written for u in self.controller.GetUsage(self._ids[texture]))

    def go_to(self, event, again=False):
        """The frame as it is after an event."""
        if again or event != self._event:
            self.controller.SetFrameEvent(event, again)
            self._event = event

    # --- The pipeline -----------------------------------------------------------------------------------------------

    def _api_state(self, pipe):
        """(conventions of clip space, depth test, whether depths are written, rasterizer's depth bias)"""
        view = pipe.GetViewport(0)
        if pipe.IsCaptureGL():
            s = self.controller.GetGLPipelineState()
            clip = s.vertexProcessing
            bias = s.rasterizer.state
            depth = s.depthState
            return (conventions.opengl(clip.clipOriginLowerLeft, clip.clipNegativeOneToOne), depth.depthFunction, depth.depthEnable and depth.depthWrites,
                    (bias.depthBias, bias.slopeScaledDepthBias, bias.offsetClamp))
        if pipe.IsCaptureVK():
            s = self.controller.GetVulkanPipelineState()
            bias = s.rasterizer
            on = getattr(bias, "depthBiasEnable", True)
            depth = s.depthStencil
            return (conventions.vulkan(view.height, s.viewportScissor.depthNegativeOneToOne), depth.depthFunction, depth.depthTestEnable and depth.depthWriteEnable,
                    (bias.depthBias, bias.slopeScaledDepthBias, bias.depthBiasClamp) if on else (0, 0, 0))
        s = self.controller.GetD3D11PipelineState() if pipe.IsCaptureD3D11() else self.controller.GetD3D12PipelineState()
        bias = s.rasterizer.state
        depth = s.outputMerger.depthStencilState
        return (conventions.DIRECT3D, depth.depthFunction, depth.depthEnable and depth.depthWrites,
                (bias.depthBias, bias.slopeScaledDepthBias, bias.depthBiasClamp))

    def state(self, event):
        """The pipeline at a draw; going to an event costs a replay, so what was seen is kept."""
        if event not in self._states:
            self._states[event] = self._state(event)
        return self._states[event]

    def _state(self, event):
        self.go_to(event)
        pipe = self.controller.GetPipelineState()
        view, target = pipe.GetViewport(0), pipe.GetDepthTarget()
        clip, compare, writes_depth, bias = self._api_state(pipe)
        target = getattr(target, "resource", target) if not hasattr(target, "resourceId") else target
        colours = [int(t.resourceId) for t in pipe.GetOutputTargets() if int(t.resourceId)]
        y, height = (view.y, view.height) if view.height >= 0 else (view.y + view.height, -view.height)
        shaders = {stage: int(pipe.GetShader(stage)) for stage in (rd.ShaderStage.Vertex, rd.ShaderStage.Fragment) if int(pipe.GetShader(stage))}
        side = self._side(pipe, clip)
        return State((view.x, y, view.width, height), colours, int(target.resourceId), getattr(target, "firstSlice", 0), clip,
                     compare in (rd.CompareFunction.Greater, rd.CompareFunction.GreaterEqual), bool(writes_depth),
                     dict(zip(("constant", "slope", "clamp"), bias)), shaders, side)

    def _side(self, pipe, clip):
        """State.side"""
        if pipe.IsCaptureGL():
            s = self.controller.GetGLPipelineState().rasterizer.state
        elif pipe.IsCaptureVK():
            s = self.controller.GetVulkanPipelineState().rasterizer
        else:
            s = (self.controller.GetD3D11PipelineState() if pipe.IsCaptureD3D11() else self.controller.GetD3D12PipelineState()).rasterizer.state
        if s.cullMode not in (rd.CullMode.Front, rd.CullMode.Back):
            return 0
        front_ccw = getattr(s, "frontCCW", True)
        left = 1 if pipe.IsCaptureGL() or clip.y_up else -1  # the sign of those that turn to the left as they are shown
        return left if front_ccw == (s.cullMode == rd.CullMode.Back) else -left

    def bindings(self, event):
        """[(texture, what its sampler does)] of the fragment shader, which may read one by way of several; "" where it is not told."""
        self.go_to(event)
        pipe, stage = self.controller.GetPipelineState(), rd.ShaderStage.Fragment
        shader = pipe.GetShaderReflection(stage)
        if not shader:
            return []
        if not hasattr(pipe, "GetBindpointMapping"):  # RenderDoc 1.33 and later
            return [(int(d.descriptor.resource), "") for d in pipe.GetReadOnlyResources(stage, True) if int(d.descriptor.resource)]
        places = pipe.GetBindpointMapping(stage).readOnlyResources
        used = {(places[r.bindPoint].bindset, places[r.bindPoint].bind) for r in shader.readOnlyResources if places[r.bindPoint].used}
        return [(int(one.resourceId), self._sampler(pipe, bound.bindPoint)) for bound in pipe.GetReadOnlyResources(stage)
                if (bound.bindPoint.bindset, bound.bindPoint.bind) in used for one in bound.resources if int(one.resourceId)]

    def _sampler(self, pipe, place):
        """"linear compare", "nearest compare", "linear" or "nearest"; "" where this API's state is not looked at."""
        if pipe.IsCaptureGL():
            samplers = self.controller.GetGLPipelineState().samplers
            if place.bind >= len(samplers):
                return ""
            s = samplers[place.bind]
        elif pipe.IsCaptureVK():
            s = self.controller.GetVulkanPipelineState().graphics.descriptorSets[place.bindset].bindings[place.bind].binds[0]
        else:
            return ""
        way = "linear" if rd.FilterMode.Linear in (s.filter.magnify, s.filter.minify) else "nearest"
        return way + (" compare" if s.filter.filter == rd.FilterFunction.Comparison else "")

    def fragment_code(self, event):
        """A draw's fragment shader: a text in GLSL, SPIR-V's bytes, b"" of another language, None where there is none."""
        shader = self.state(event).shaders.get(rd.ShaderStage.Fragment)
        if shader not in self._code:
            self.go_to(event)
            reflected = self.controller.GetPipelineState().GetShaderReflection(rd.ShaderStage.Fragment)
            raw = bytes(reflected.rawBytes) if reflected else b""
            text = reflected and reflected.encoding == rd.ShaderEncoding.GLSL
            spoken = reflected and reflected.encoding in (rd.ShaderEncoding.SPIRV, getattr(rd.ShaderEncoding, "OpenGLSPIRV", rd.ShaderEncoding.SPIRV))
            self._code[shader] = None if not shader else raw.decode(errors="replace") if text else raw if spoken else b""
        return self._code[shader]

    def glsl(self, event):
        """The text of a draw's fragment shader; "" where the API has none in GLSL."""
        code = self.fragment_code(event)
        return code if isinstance(code, str) else ""

    def constants(self, event):
        """([(name, 4x4 matrix)], [(name, number)]) of both shaders of a draw."""
        self.go_to(event)
        pipe = self.controller.GetPipelineState()
        matrices, numbers = [], []
        for stage in (rd.ShaderStage.Vertex, rd.ShaderStage.Fragment):
            shader = pipe.GetShaderReflection(stage)
            for index, block in enumerate(shader.constantBlocks if shader else ()):
                for variable in self._block(pipe, stage, shader, index) if len(block.variables) else ():
                    _gather(variable, block.name + "." if block.name else "", matrices, numbers)
        return matrices, numbers

    def _block(self, pipe, stage, shader, index):
        if hasattr(pipe, "GetConstantBuffer"):
            buffer = pipe.GetConstantBuffer(stage, index, 0)
            resource = buffer.resourceId
        else:  # RenderDoc 1.33 and later
            buffer = pipe.GetConstantBlock(stage, index, 0).descriptor
            resource = buffer.resource
        size = buffer.byteSize if buffer.byteSize < 1 << 40 else 0
        return self.controller.GetCBufferVariableContents(pipe.GetGraphicsPipelineObject(), shader.resourceId, stage, shader.entryPoint,
                                                          index, resource, buffer.byteOffset, size)

    # --- Geometry ---------------------------------------------------------------------------------------------------

    def _indices(self, resource, offset, stride, count, base):
        data = self.controller.GetBufferData(resource, offset, count * stride)
        kind = {1: np.uint8, 2: np.uint16, 4: np.uint32}[stride]
        raw = np.frombuffer(data, kind, len(data) // stride)[:count]
        return raw.astype(np.int32) + np.int32(base), raw == np.iinfo(kind).max

    def meshes(self, draw):
        """A Mesh for each instance of a draw that is made of triangles."""
        self.go_to(draw.event)
        pipe, action = self.controller.GetPipelineState(), self._actions[draw.event]
        source = self._source(pipe, action)
        turned = self._source(pipe, action, ("norm",))
        called_by = self._name(pipe, action, source[2] if source else next(iter(pipe.GetVBuffers()), None))
        out = []
        for instance in range(draw.instances):
            drawn = self._clip(action, instance)
            if drawn is None:
                continue
            vertices, indices, places = drawn
            kept, corners = formats.numbered(indices[places])
            objects = normals = None
            if source:
                points, order, _ = source
                if len(order) > places.max():
                    place_of = np.empty(len(kept), np.int32)  # one of the places at which a vertex stands among the indices
                    place_of[corners] = places
                    objects = points[order[place_of]]
                    normals = turned and turned[0][turned[1][place_of]]
            called = f"event {draw.event}" + (f", instance {instance}" if draw.instances > 1 else "")
            one = Mesh(draw.event, vertices[kept].astype(float), objects, corners, called_by, called, normals=normals)
            out += self._of_geometry(pipe, one, instance) if int(pipe.GetShader(rd.ShaderStage.Geometry)) else [one]
        return out

    def _of_geometry(self, pipe, mesh, instance):
        """What a geometry shader makes of a mesh, in each layer that it chooses: where it hands every triangle on, the same vertices, moved; of
        others nothing is told."""
        made = self.controller.GetPostVSData(instance, 0, rd.MeshDataStage.GSOut)
        if not int(made.vertexResourceId) or not made.numIndices:
            return []
        words = made.vertexByteStride // 4
        data = self.controller.GetBufferData(made.vertexResourceId, made.vertexByteOffset, made.numIndices * made.vertexByteStride)
        rows = np.frombuffer(data, np.float32, len(data) // 4 // words * words).reshape(-1, words)
        before, layers = 4, None  # its position comes first, then what else it hands on
        for signature in pipe.GetShaderReflection(rd.ShaderStage.Geometry).outputSignature:
            if signature.systemValue == rd.ShaderBuiltin.RTIndex:
                layers = rows.view(np.int32)[:, before]
            before += signature.compCount if signature.systemValue != rd.ShaderBuiltin.Position else 0
        out = []
        for layer in [None] if layers is None else np.unique(layers):
            mine = rows[:, :4] if layer is None else rows[layers == layer, :4]
            if len(mine) == len(mesh.corners):
                clip = np.empty_like(mesh.clip)
                clip[mesh.corners] = mine
                out.append(replace(mesh, clip=clip, layer=None if layer is None else int(layer)))
        return out

    def _name(self, pipe, action, buffer):
        """What names a draw's vertices: the buffers that it goes through, of which `buffer` holds positions, and which part of them."""
        indexed = bool(action.flags & rd.ActionFlags.Indexed)
        return (int(buffer.resourceId) if buffer else 0, buffer.byteOffset if buffer else 0, int(pipe.GetIBuffer().resourceId) if indexed else 0,
                action.indexOffset, action.vertexOffset, action.baseVertex, action.numIndices, action.instanceOffset)

    def writes_own_depth(self, event):
        """Whether a draw's fragment shader chooses depths itself; of a language that is not read, it does not."""
        code = self.fragment_code(event)
        return bool(code) and ("gl_FragDepth" in literals.without_comments(code) if isinstance(code, str) else spirv.replaces_depth(code))

    def _clip(self, action, instance):
        """(clip positions of vertices, each index, corners of triangles as places among the indices), or None."""
        mesh = self.controller.GetPostVSData(instance, 0, rd.MeshDataStage.VSOut)
        if not int(mesh.vertexResourceId) or not mesh.numIndices:
            return None
        stride = mesh.vertexByteStride
        data = self.controller.GetBufferData(mesh.vertexResourceId, mesh.vertexByteOffset, 0)
        count = (len(data) - 16) // stride + 1
        values = np.frombuffer(data, np.float32, len(data) // 4)
        vertices = np.lib.stride_tricks.as_strided(values, (count, 4), (stride, 4))
        if int(mesh.indexResourceId) and mesh.indexByteStride:
            indices, restart = self._indices(mesh.indexResourceId, mesh.indexByteOffset, mesh.indexByteStride, mesh.numIndices, mesh.baseVertex)
            restart = restart if action.flags & rd.ActionFlags.Indexed else np.zeros(len(restart), bool)
        else:
            indices, restart = np.arange(mesh.numIndices, dtype=np.int32), np.zeros(mesh.numIndices, bool)
        corners = formats.corners(_topology(mesh.topology), restart)
        if corners is None or not len(corners):
            return None
        used = indices[corners]
        if used.min() < 0 or used.max() >= count:
            indices = indices - used.min()
        return vertices, np.clip(indices, 0, count - 1, out=indices), corners

    def _source(self, pipe, action, called=()):
        """(object positions, the row of each index among them, their buffer), or None where no attribute is three numbers. `called`: the same of an
        attribute whose name has one of these words, in place of positions."""
        fit = [a for a in pipe.GetVertexInputs() if formats.of_attribute(a.format.compType.name, a.format.compByteWidth) and a.format.compCount >= 3
               and not a.perInstance and (not called or any(word in a.name.lower() for word in called))]
        if not fit:
            return None
        fit.sort(key=lambda a: (not any(word in a.name.lower() for word in ("pos", "vert")), a.format.compType != rd.CompType.Float, -a.format.compByteWidth))
        attribute = fit[0]
        kind, largest = formats.of_attribute(attribute.format.compType.name, attribute.format.compByteWidth)
        buffer = pipe.GetVBuffers()[attribute.vertexBuffer]
        indexed = bool(action.flags & rd.ActionFlags.Indexed)
        index = pipe.GetIBuffer()
        if indexed:
            order, restart = self._indices(index.resourceId, index.byteOffset + action.indexOffset * index.byteStride, index.byteStride,
                                           action.numIndices, action.baseVertex)
            order[restart] = 0
        else:
            order = np.arange(action.numIndices, dtype=np.int32) + np.int32(action.vertexOffset)
        width = attribute.format.compByteWidth
        stride = buffer.byteStride or width * attribute.format.compCount
        data = self.controller.GetBufferData(buffer.resourceId, buffer.byteOffset + attribute.byteOffset, (int(order.max()) + 1) * stride)
        values = np.frombuffer(data, kind, len(data) // width)
        count = (len(data) // width * width - 3 * width) // stride + 1
        points = np.lib.stride_tricks.as_strided(values, (count, 3), (stride, width))
        points = points if width == 4 else points / np.float32(largest)
        return points, np.clip(order, 0, count - 1, out=order), buffer

    # --- Pictures ---------------------------------------------------------------------------------------------------

    def picture(self, texture, slice_=0):
        """Channels of a texture as they are now, [rows, columns, channels], the texture's own first row first; of several samples a pixel the
        mean."""
        return self.samples(texture, slice_).mean(0) if self.textures[texture].samples > 1 else self._sample(texture, slice_, 0)

    def samples(self, texture, slice_=0):
        """The same of each sample of a pixel, [samples, rows, columns, channels]."""
        return np.array([self._sample(texture, slice_, k) for k in range(self.textures[texture].samples)])

    def _sample(self, texture, slice_, sample):
        t = self.textures[texture]
        data = self.controller.GetTextureData(self._ids[texture], rd.Subresource(0, slice_, sample))
        opengl = self.controller.GetPipelineState().IsCaptureGL()
        return formats.decode(data, t.format, t.width, t.height, opengl)

    def shows(self, event, depth, final, cut):
        """Pixels of a depth texture that a draw writes and that nothing later writes over, of which `final` is left; `cut` takes the camera's
        part of a picture."""
        self.go_to(event - 1)
        before = cut(self.picture(depth)[..., 0])
        self.go_to(event)
        after = cut(self.picture(depth)[..., 0])
        return (after != before) & (after == final)

    @contextmanager
    def replaced(self, shaders):
        """The frame with shaders exchanged: {(id, stage): stand_ins.Source}."""
        pipe = self.controller.GetPipelineState()
        made = []
        try:
            for (shader, stage), source in shaders.items():
                encoding, code = stand_ins.encoded(source, pipe, self.controller.GetTargetShaderEncodings())
                new, message = self.controller.BuildTargetShader("main", encoding, code, rd.ShaderCompileFlags(), stage)
                if not int(new):
                    raise FrameError(f"a shader that takes a caster away cannot be built here: {message}")
                original = self._shader_id(shader, stage)
                self.controller.ReplaceResource(original, new)
                made.append((original, new))
            self._event = None
            yield
        finally:
            for original, new in made:
                self.controller.RemoveReplacement(original)
                self.controller.FreeTargetResource(new)
            self._event = None

    @contextmanager
    def without_shading(self, draws):
        """The frame with fragment shaders of these draws that do nothing. Vertices and states stay, and going to a draw, which replays all that comes
        before it, costs little."""
        stage, known = rd.ShaderStage.Fragment, set()
        with ExitStack() as stack:
            for draw in draws:  # each next one that is gone to finds those before it replaced
                shader = self.state(draw.event).shaders.get(stage)
                if shader not in (None, *known):
                    known.add(shader)
                    try:
                        stack.enter_context(self.replaced({(shader, stage): stand_ins.Source(True, False, plain=True)}))
                    except FrameError:
                        break  # it only takes longer
            yield

    def _shader_id(self, shader, stage):
        return next(r.resourceId for r in self.controller.GetResources() if int(r.resourceId) == shader)


def _gather(variable, path, matrices, numbers):
    name = path + variable.name
    if len(variable.members):
        for member in variable.members:
            _gather(member, name + ("" if member.name.startswith("[") else "."), matrices, numbers)
    elif variable.type == rd.VarType.Float:
        count = variable.rows * variable.columns
        values = np.array([variable.value.f32v[k] for k in range(count)], float)
        if variable.rows == 4 and variable.columns == 4:
            matrices.append((name, values.reshape(4, 4)))
        elif count <= 4:
            numbers += [(f"{name}{'.' + 'xyzw'[k] if count > 1 else ''}", float(v)) for k, v in enumerate(values)]


def _topology(topology):
    return {rd.Topology.TriangleList: "list", rd.Topology.TriangleStrip: "strip", rd.Topology.TriangleFan: "fan"}.get(topology, "")
