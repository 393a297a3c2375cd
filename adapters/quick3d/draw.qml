// Qt Quick 3D (Qt 6): draws the boxes of Gnomon's scene floating-box with the engine's own shadows, so that RenderDoc can record a
// frame: QSG_RHI_BACKEND=vulkan QSG_RENDER_LOOP=basic /usr/lib/qt6/bin/qml draw.qml -- --size=320x180. Something has to move, or the shadow's pass is not in
// every frame; what moves is a red dot in the window's corner and the camera's far plane, by a tenth of a millimetre.
import QtQuick
import QtQuick.Window
import QtQuick3D

Window {
  readonly property var sides: (Qt.application.arguments.find(word => word.startsWith("--size=")) || "--size=320x180").slice(7).split("x")

  visible: true
  width: Number(sides[0])
  height: Number(sides[1])
  color: "transparent"

  component Box: Model {
    source: "#Cube" // 100 units wide
    scale: Qt.vector3d(0.006, 0.006, 0.006)
    eulerRotation.y: 18
    materials: PrincipledMaterial { baseColor: "white"; roughness: 1; specularAmount: 0; cullMode: Material.NoCulling }
  }

  Rectangle {
    width: 2
    height: 2
    color: "red"
    z: 9
    NumberAnimation on x { from: 0; to: 5; duration: 300; loops: Animation.Infinite }
  }
  View3D {
    anchors.fill: parent
    renderMode: View3D.Underlay
    camera: camera
    environment: SceneEnvironment {
      clearColor: "black"
      backgroundMode: SceneEnvironment.Color
      antialiasingMode: SceneEnvironment.NoAA
      tonemapMode: SceneEnvironment.TonemapModeNone
    }
    PerspectiveCamera {
      id: camera
      position: Qt.vector3d(0.55, 2.8, 4.9)
      rotation: Qt.quaternion(0.965206457, -0.258789795, 0.0361960489, 0.00970483364)
      fieldOfView: 32
      clipNear: 0.05
      clipFar: 15.23
      NumberAnimation on clipFar { from: 15.23; to: 15.2301; duration: 300; loops: Animation.Infinite }
    }
    DirectionalLight {
      rotation: Qt.quaternion(0.445603036, -0.859559273, 0, 0.250191509)
      castsShadow: true
      shadowMapQuality: Light.ShadowMapQualityHigh
      shadowFactor: 75 // the strength, percent
      shadowBias: 0
      shadowMapFar: 30
    }
    Model {
      source: "#Rectangle"
      scale: Qt.vector3d(0.24, 0.2, 1)
      eulerRotation.x: -90
      materials: PrincipledMaterial { baseColor: "white"; roughness: 1; specularAmount: 0; cullMode: Material.NoCulling }
    }
    Box { position: Qt.vector3d(-2, 0.3, 0) }
    Box { position: Qt.vector3d(-1, 0.32, 0) }
    Box { position: Qt.vector3d(0, 0.35, 0) }
    Box { position: Qt.vector3d(1, 0.4, 0) }
    Box { position: Qt.vector3d(2, 0.5, 0) }
  }
}
