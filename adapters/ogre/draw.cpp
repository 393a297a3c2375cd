// Draws boxes on and above a floor with OGRE 1.12's own depth shadow map of a sun, frame after frame, so that RenderDoc can
// record one: draw FOLDER_OF_THE_MATERIAL BIAS. The bias is the reader's, stored depth. renderdoc_engine_test compiles it.
#include <Ogre.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace {

constexpr unsigned width = 320, height = 180;

/// A box between two corners, whose faces have normals of their own.
void add_box(Ogre::SceneManager& scene, const Ogre::Vector3& size, const Ogre::Vector3& place) {
  Ogre::ManualObject* box = scene.createManualObject();
  box->begin("shadowed", Ogre::RenderOperation::OT_TRIANGLE_LIST);
  unsigned first = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-0.5f, 0.5f}) {
      Ogre::Vector3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side < 0.0f ? -1.0f : 1.0f, u[(axis + 1) % 3] = 0.5f, v[(axis + 2) % 3] = 0.5f;
      const Ogre::Vector3 middle = 0.5f * normal;
      for (const auto& [a, b] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        box->position((middle + a * u + b * v) * size);
        box->normal(normal);
      }
      if (side > 0.0f)
        box->quad(first, first + 1, first + 2, first + 3);
      else
        box->quad(first + 3, first + 2, first + 1, first);
      first += 4;
    }
  box->end();
  const Ogre::MeshPtr mesh = box->convertToMesh("box" + Ogre::StringConverter::toString(place.x));
  Ogre::Entity* entity = scene.createEntity(mesh);
  scene.getRootSceneNode()->createChildSceneNode(place)->attachObject(entity);
}

void set_shadows(Ogre::SceneManager& scene) {
  scene.setShadowTechnique(Ogre::SHADOWTYPE_TEXTURE_ADDITIVE_INTEGRATED);
  scene.setShadowTextureSettings(1024, 1, Ogre::PF_DEPTH16);
  scene.setShadowTextureCasterMaterial(Ogre::MaterialManager::getSingleton().getByName("caster"));
  scene.setShadowTextureSelfShadow(true);
  scene.setShadowCasterRenderBackFaces(false);
  scene.setShadowFarDistance(20.0f);
  scene.setShadowDirectionalLightExtrusionDistance(20.0f);
}

void look(Ogre::SceneManager& scene, Ogre::RenderWindow& window) {
  Ogre::Camera* camera = scene.createCamera("camera");
  camera->setNearClipDistance(0.1f);
  camera->setFarClipDistance(40.0f);
  camera->setAspectRatio(Ogre::Real(width) / height);
  camera->setFOVy(Ogre::Degree(40));
  Ogre::SceneNode* node = scene.getRootSceneNode()->createChildSceneNode(Ogre::Vector3(0.5f, 2.8f, 5.0f));
  node->attachObject(camera);
  node->lookAt(Ogre::Vector3(0.0f, 0.2f, 0.0f), Ogre::Node::TS_WORLD);
  window.addViewport(camera)->setBackgroundColour(Ogre::ColourValue::Black);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Ogre::LogManager log;
  log.createLog("ogre.log", true, false, true);  // no file
  Ogre::Root root("", "", "");
  root.loadPlugin(OGRE_PLUGIN);
  root.setRenderSystem(root.getAvailableRenderers().front());
  root.initialise(false);
  Ogre::RenderWindow* window = root.createRenderWindow("ogre", width, height, false);
  auto& resources = Ogre::ResourceGroupManager::getSingleton();
  resources.addResourceLocation(argv[1], "FileSystem");
  resources.addResourceLocation(OGRE_MEDIA "/ShadowVolume",
                                "FileSystem");  // which OGRE asks for, whatever the technique
  resources.initialiseAllResourceGroups();
  Ogre::SceneManager* scene = root.createSceneManager();
  Ogre::Pass* pass = Ogre::MaterialManager::getSingleton().getByName("shadowed")->getTechnique(0)->getPass(0);
  pass->getFragmentProgramParameters()->setNamedConstant("bias", Ogre::Real(std::atof(argv[2])));
  set_shadows(*scene);
  look(*scene, *window);
  Ogre::Light* sun = scene->createLight("sun");
  sun->setType(Ogre::Light::LT_DIRECTIONAL);
  sun->setShadowNearClipDistance(5.0f);
  sun->setShadowFarClipDistance(40.0f);
  Ogre::SceneNode* turned = scene->getRootSceneNode()->createChildSceneNode();
  turned->setDirection(Ogre::Vector3(-0.5f, -1.0f, -0.4f).normalisedCopy(), Ogre::Node::TS_WORLD);
  turned->attachObject(sun);
  add_box(*scene, {12.0f, 0.2f, 10.0f}, {0.0f, -0.1f, 0.0f});
  for (int i = 0; i < 4; ++i)
    add_box(*scene, Ogre::Vector3(0.6f), {1.1f * float(i) - 1.6f, 0.3f + 0.06f * float(i), 0.1f * float(i)});
  while (root.renderOneFrame())
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // slow enough for a recorder to come in
}
