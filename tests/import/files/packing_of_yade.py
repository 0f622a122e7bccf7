"""Writes the files yade-* with Yade 2023.02a (Debian): K=0 yade -x -n packing_of_yade.py; K=1 yade ... Each starts anew and stops at another step."""
import os

from yade import export, utils

number = int(os.environ["K"])
O.materials.append(FrictMat(young=1e6, poisson=0.3, density=2600, frictionAngle=0.5))
O.bodies.append(utils.wall(0.0, axis=2))
for x, z in ((0.0, 0.0495), (0.098, 0.0495), (0.049, 0.133), (0.2, 0.05)):
    O.bodies.append(utils.sphere((x, 0, z), 0.05))
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                             [Law2_ScGeom_FrictPhys_CundallStrack()]),
             NewtonIntegrator(gravity=(1, 0, -9.81), damping=0.1)]
O.dt = 1e-5
for step in range(100 * (number + 1)):
    O.step()
export.textExt(f"yade-{number}.txt", format="x_y_z_r_attrs", attrs=[f"b.state.vel[{k}]" for k in range(3)] + ["b.id"])
exporter = export.VTKExporter("yade-export", startSnap=number)
exporter.exportInteractions(what={"fn": "i.phys.normalForce", "fs": "i.phys.shearForce", "normal": "i.geom.normal", "first": "i.id1", "second": "i.id2"})
with open(f"yade-forces-{number}.txt", "w") as stream:
    for body in range(1, 5):
        stream.write("%.12g %.12g %.12g\n" % tuple(O.forces.f(body)))
VTKRecorder(fileName="yade-", recorders=["spheres", "velocity", "id"])()
os._exit(0)
