"""Sections of docs/benchmarks.md from what programs print: bench/continuum and bench/scaling (bench/report)."""


def continuum_part(text):
    """As the program prints it, with a diagram of each problem."""
    out = "## Against the sheet that a grid stands for\n\n"
    out += ("A grid's own motion is no truth for somebody who drapes cloth: the truth here is the limit of ever finer "
            "grids, by Richardson's extrapolation of three in double precision, each with substeps that change "
            "nothing, or a closed form; how well it is known is said beside it. Cloth weighs 0.3 kg/m². The sheets "
            "of `curtain`, `curtain_membrane` and `woven`, 1 m square, are held along one side and fall for half a "
            "second with drag. Resolution, method and substeps are free, on one thread; a run is the whole motion "
            "without setting up. *All alike*: edges that do not count half, as lattices have it in most programs. "
            "Bullet's links know no bending and no half edges. Blender's cloth, stepped by a script without a "
            "window, has springs, dihedral angles that bend and one mass for all vertices; its substeps are those "
            "of a frame of 1/32 s.\n\n")
    for section in text.split("\n## ")[1:]:
        name, rest = section.split("\n", 1)
        about, tables = rest.strip().split("\n\n", 1)
        out += f"### {name}\n\n{about[:1].upper()}{about[1:]}\n\n"
        out += f"![{name}: run time against distance from the continuum](pictures/continuum_{name}.svg)\n\n"
        out += tables.strip() + "\n\n"
    return out


def scaling_part(text):
    """As the program prints it: all scenes first, then one by one."""
    sharing, *sections = text.split("\n\n", 1)[1].split("\n## ")
    last = [s for s in sections if s.startswith(("All scenes", "Gains"))]
    out = "## More threads than there are\n\n"
    out += ("`bench/scaling` runs a frame on one thread, cut into the tasks that P threads would get, and keeps each "
            "task's shortest duration and what it waits for. A list schedule then gives them to P workers: whoever is "
            "idle takes the task that has been ready for longest, and whoever ends one goes on with the first that "
            "it has made ready, as the library's threads do. It counts what sharing costs here: taking a task, telling "
            "another core, waking a thread, rows that another core has written, memory. What it says of two threads "
            "stands beside what two take.\n\n*Bound by*: the greatest of the work each thread has, the longest "
            "chain of tasks that wait for each other, what sharing costs, and memory.\n\n")
    out += sharing.strip() + "\n\n![time of a frame by threads](pictures/scaling.svg)\n\n"
    for section in last:
        name, rest = section.split("\n", 1)
        out += (f"### {name}\n\n" if name.startswith("Gains") else "") + rest.strip() + "\n\n"
    out += "<details><summary>Scene by scene</summary>\n\n"
    for section in sections:
        if section not in last:
            name, rest = section.split("\n", 1)
            out += f"**{name}**: {rest.strip()}\n\n"
    return out + "</details>\n\n"
