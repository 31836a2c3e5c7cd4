"""kernel_table.py FOLDER DEVICE...: prints a table of the kernels that scripts/gpu_compilers compiled. FOLDER has a
file DEVICE.tsv for each device: one line for each kernel, as the program kernel_costs prints it. The file FOLDER/all.md
gets a row for each kernel with each set of definitions. The printed table has the largest of these sets."""
import pathlib
import re
import sys

INTEL = re.compile(r"CS SIMD(\d+) shader: (\d+) inst, (\d+) loops, (\d+) cycles, (\d+):(\d+) spills:fills")
AMD = re.compile(r"Shader Stats: SGPRS: (\d+) VGPRS: (\d+) Code Size: (\d+) LDS: (\d+) Scratch: (\d+) Max Waves: (\d+) "
                 r"Spilled SGPRs: (\d+) Spilled VGPRs: (\d+) [^\t]*\(CS, W(\d+)\)")


def intel_costs(text):
    """The variant that the driver takes: the widest one without spills, or else the narrowest."""
    variants = [tuple(int(number) for number in match) for match in INTEL.findall(text)]
    if not variants:
        return None
    whole = [variant for variant in variants if variant[4] == 0]
    simd, instructions, _, _, spills, fills = max(whole) if whole else min(variants)
    extra = f", {spills:,} spills, {fills:,} fills" if spills else ""
    return instructions, f"SIMD{simd}, {instructions:,} instructions{extra}"


def amd_costs(text):
    found = [tuple(int(number) for number in match) for match in AMD.findall(text)]
    if not found:
        return None
    _, registers, code, _, scratch, waves, spilled_scalars, spilled, lanes = found[-1]
    extra = f", {scratch:,} bytes of scratch" if scratch else ""
    extra += f", {spilled + spilled_scalars:,} spills" if spilled + spilled_scalars else ""
    return code, f"{lanes} lanes, {registers} registers, {waves} waves, {code / 1024:,.1f} KiB{extra}"


def read(path):
    """Returns {kernel: (size, costs, seconds)}."""
    kernels = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        parts = line.split("\t")
        if len(parts) < 2:  # the rest of a log of several lines
            continue
        kernel, seconds, text = parts[0], float(parts[1]), "\t".join(parts[2:])
        failure = re.search(r"(?:^|\t)(failed: .*)", text)
        costs = intel_costs(text) or amd_costs(text) or (0, "no report")
        if failure:
            costs = (float("inf"), failure.group(1))
        kernels[kernel] = (*costs, seconds)
    return kernels


def table(devices, rows):
    """`rows`: {kernel: [text of each device]}."""
    lines = [f"| kernel | {' | '.join(devices)} |", "| --- " * (len(devices) + 1) + "|"]
    return "\n".join(lines + [f"| {kernel} | {' | '.join(rows[kernel])} |" for kernel in rows]) + "\n"


def main():
    folder, devices = pathlib.Path(sys.argv[1]), sys.argv[2:]
    results = [read(folder / f"{device}.tsv") for device in devices]
    kernels = sorted({kernel for result in results for kernel in result})

    def cell(entry):
        return f"{entry[1]}, {entry[2]:.1f} s" if entry else "–"

    (folder / "all.md").write_text(table(devices, {
        kernel: [cell(result.get(kernel)) for result in results] for kernel in kernels}), encoding="utf-8")

    def name(kernel):
        return kernel if kernel.startswith("kinematics ") else kernel.split(" ")[0]

    def largest(result, short):
        return max((entry for kernel, entry in result.items() if name(kernel) == short), default=None)

    print(table(devices, {short: [cell(largest(result, short)) for result in results]
                          for short in sorted({name(kernel) for kernel in kernels})}))
    for device, result in zip(devices, results):
        failed = sum(entry[1].startswith("failed") for entry in result.values())
        seconds = sum(entry[2] for entry in result.values())
        print(f"{device}: {len(result)} programs in {seconds:.0f} s, {failed} failed")


if __name__ == "__main__":
    main()
