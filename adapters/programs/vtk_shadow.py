"""VTK's vtkShadowMapPass, for record.py: a spot light that moves, so that its map is drawn in every frame.
/usr/bin/python3 vtk_shadow.py [WIDTH HEIGHT]"""
import math
import sys

import vtkmodules.vtkInteractionStyle  # noqa: F401
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow
from vtkmodules.vtkRenderingOpenGL2 import vtkCameraPass, vtkRenderPassCollection, vtkSequencePass, vtkShadowMapPass


def add(renderer, source, colour, place=(0, 0, 0)):
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputConnection(source.GetOutputPort())
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.SetPosition(*place)
    renderer.AddActor(actor)


def main():
    renderer, window = vtkRenderer(), vtkRenderWindow()
    window.SetSize(*(map(int, sys.argv[1:3]) if sys.argv[2:] else (320, 180)))
    window.SetMultiSamples(0)
    window.AddRenderer(renderer)
    floor, bar, ball = vtkPlaneSource(), vtkCubeSource(), vtkSphereSource()
    floor.SetOrigin(-6, 0, 6)
    floor.SetPoint1(6, 0, 6)
    floor.SetPoint2(-6, 0, -6)
    floor.SetResolution(8, 8)
    bar.SetXLength(0.3)
    bar.SetYLength(2)
    ball.SetRadius(0.7)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(24)
    add(renderer, floor, (0.8, 0.8, 0.7))
    add(renderer, vtkCubeSource(), (0.9, 0.3, 0.2), (-1, 0.5, 0))
    add(renderer, bar, (0.3, 0.8, 0.2), (1.5, 1, -0.5))
    add(renderer, ball, (0.2, 0.4, 0.9), (0.6, 0.7, 1.4))
    light = vtkLight()
    light.SetPositional(True)
    light.SetConeAngle(35)
    light.SetFocalPoint(0, 0, 0)
    renderer.AddLight(light)
    shadows, both, passes, camera = vtkShadowMapPass(), vtkRenderPassCollection(), vtkSequencePass(), vtkCameraPass()
    shadows.GetShadowMapBakerPass().SetResolution(512)
    both.AddItem(shadows.GetShadowMapBakerPass())
    both.AddItem(shadows)
    passes.SetPasses(both)
    camera.SetDelegatePass(passes)
    renderer.SetPass(camera)
    renderer.GetActiveCamera().SetPosition(4, 4, 6)
    renderer.GetActiveCamera().SetFocalPoint(0, 0.3, 0)
    for k in range(100000):
        light.SetPosition(4 + 0.3 * math.sin(0.1 * k), 7, 3)
        renderer.ResetCameraClippingRange()
        window.Render()


main()
