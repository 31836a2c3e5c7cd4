"""A client of several planning_scene_nodes with the same scene: see docs/replicas.md.

Only this module of the package needs rospy, which it loads when a checker is made.
"""
import copy
import threading
import time

__all__ = ["ShardedChecker"]

UNSPLIT_STATES = 4096  # of a request for one node: fewer are not worth the threads
LEAST_PART = 2048  # states
PARTS_PER_NODE = 2  # or more, so that a slow node does not hold up the others
PAUSE = 0.02  # seconds, before a busy node is asked again
RETRY = 0.05  # seconds, between two rounds with all nodes

ANSWERED, UNABLE, BUSY, OTHER_SCENES, REFUSED = range(5)


def _outcome(response, revision):
    """What a response means: see Status.msg.

    A node with an internal error counts as one that refuses the request: other nodes get the request too, but if all of
    them fail, the client does not try again and again.
    """
    from gpu_planning_scene.msg import Status
    if response is None:
        return UNABLE
    if response.status == Status.OK:
        return ANSWERED if revision in (0, response.scene_revision) else OTHER_SCENES
    return {Status.BUSY: BUSY, Status.UNKNOWN_REVISION: OTHER_SCENES, Status.SHUTTING_DOWN: UNABLE,
            Status.UNAVAILABLE: UNABLE}.get(response.status, REFUSED)


class _Node:
    """The connections to a node. They stay open. Calls at the same time have connections of their own."""

    def __init__(self, name, timeout):
        import rospy
        self.name = name
        self._rospy = rospy
        self._timeout = timeout
        self._lock = threading.Lock()
        self._idle = {}

    def call(self, name, service, request):
        """The response; None if the node does not answer in time."""
        with self._lock:
            idle = self._idle.setdefault(name, [])
            proxy = idle.pop() if idle else self._rospy.ServiceProxy(f"{self.name}/{name}", service, persistent=True)
        # rospy waits for an answer without a limit. After the timeout, the connection is closed, which ends the call.
        timer = threading.Timer(self._timeout, self._end, (proxy,))
        timer.daemon = True
        timer.start()
        try:
            response = proxy(request)
        except (self._rospy.ServiceException, self._rospy.ROSException, OSError):
            proxy.close()
            return None
        finally:
            timer.cancel()
        with self._lock:
            idle.append(proxy)
        return response

    @staticmethod
    def _end(proxy):
        transport = proxy.transport
        if transport is not None and transport.socket is not None:
            try:
                transport.socket.shutdown(2)
            except OSError:
                pass  # it is closed already


class _Work:
    """The parts of a request, which several threads send to their nodes."""

    def __init__(self, parts):
        self.parts = parts
        self.answers = [None] * len(parts)
        self._open = list(range(len(parts)))
        self._changed = threading.Condition()

    def take(self):
        """A part that nobody has. Waits while others have all open parts. None: all parts are answered."""
        with self._changed:
            self._changed.wait_for(lambda: self._open or self.answered() == len(self.parts))
            return self._open.pop(0) if self._open else None

    def answer(self, part, answer):
        with self._changed:
            self.answers[part] = answer
            self._changed.notify_all()

    def give_back(self, part):
        with self._changed:
            self._open.insert(0, part)
            self._changed.notify()

    def answered(self):
        return sum(answer is not None for answer in self.answers)


class _Failures:
    """What the nodes answered in a round that left parts unanswered."""

    def __init__(self):
        self._all = []

    def add(self, outcome, status, text):
        self._all.append((outcome, status, text))

    def reported(self):
        """The status and the text for the user."""
        refusals = [failure for failure in self._all if failure[0] == REFUSED]
        return (refusals or self._all)[-1][1:]

    def are_final(self):
        """Whether no other node and no later time will help."""
        return all(outcome == REFUSED for outcome, _, _ in self._all)

    def lack_scene(self):
        return any(outcome == OTHER_SCENES for outcome, _, _ in self._all)


class ShardedChecker:
    """Calls ~check_states of several nodes as if they were one: a leader and nodes that follow it (~follow).

    It sends the states of a large request in parts to all nodes. All parts of an answer belong to one revision of the
    scene, and to the same values of the joints that the request does not name. A part that a node does not answer (it
    was killed, is busy, shuts down, or does not have the revision) is sent to another node. Threads may share a
    checker.

    nodes: the full names of the nodes, the leader first, for example ["/planning_scene", "/planning_scene_1"].
    part_states: most states of a part. timeout: seconds; a node that has not answered a call by then counts as failed.
    patience: seconds to try on while no node answers.

        check = ShardedChecker(["/planning_scene", "/planning_scene_1"])
        answer = check(joint_names=["shoulder", "elbow"], positions=[0.0, 0.1, 0.2, 0.3])
    """

    def __init__(self, nodes, part_states=16384, timeout=30.0, patience=10.0):
        from gpu_planning_scene.msg import PlanningScene, PlanningSceneComponents, Status
        from gpu_planning_scene.srv import CheckStates, CheckStatesRequest, CheckStatesResponse
        from gpu_planning_scene.srv import GetPlanningScene, GetPlanningSceneRequest, GetReport, GetReportRequest
        if not nodes:
            raise ValueError("a ShardedChecker needs at least one node; give the name of the leader first")
        self._nodes = [_Node(name, timeout) for name in nodes]
        self._part_states = part_states
        self._patience = patience
        self._next = 0
        self._variables = 0
        self._check_states = CheckStates
        self._request = CheckStatesRequest
        self._response = CheckStatesResponse
        self._no_change = PlanningScene()
        self._unavailable = Status.UNAVAILABLE
        self._unknown_revision = Status.UNKNOWN_REVISION
        state = GetPlanningSceneRequest(PlanningSceneComponents(components=PlanningSceneComponents.ROBOT_STATE))
        self._ask_state = ("get_planning_scene", GetPlanningScene, state)
        self._ask_report = ("get_report", GetReport, GetReportRequest())

    def __call__(self, *args, **kwargs):
        """As a rospy.ServiceProxy of ~check_states: a CheckStatesRequest, or its fields. Returns a CheckStatesResponse.

        If the request names no revision, it is the newest one of the first node that answers: that of the leader, while
        it runs. success is False if all nodes refuse the request, or if no node has answered for `patience` seconds.
        status then has the reason of a node that refuses the request, or the last reason; UNAVAILABLE if a node has not
        replied. seconds is the sum of the parts. These requests go to one node as a whole: at most 4096 states; with a
        scene_diff; with a joint for which neither the request nor the first node gives a value, for example a base
        whose pose only tf knows.
        """
        request = args[0] if args and isinstance(args[0], self._request) else self._request(*args, **kwargs)
        until = time.monotonic() + self._patience
        work = None
        status, text = self._unavailable, "no node gives its scene"
        while True:
            scene = self._scene() if work is None else None
            if scene:
                work = _Work(self._split(request, scene))
            if work:
                answered = work.answered()
                failures = _Failures()
                self._serve_all(work, failures, until)
                if work.answered() == len(work.parts):
                    return _joined(work.answers)
                status, text = failures.reported()
                if failures.are_final():
                    return self._failed(status, text)
                if work.answered() > answered:
                    until = time.monotonic() + self._patience
                # The next round begins with the newest scene, unless the request names another one.
                if failures.lack_scene() and request.scene_revision == 0:
                    work = None
            if time.monotonic() > until:
                return self._failed(status, "no node can answer; the last reason: " + text)
            time.sleep(RETRY)

    def _failed(self, status, text):
        return self._response(success=False, status=status, message=text)

    def _scene(self):
        """The revision and the robot's state of the first node that answers; None if none does."""
        for node in self._nodes:
            response = node.call(*self._ask_state)
            if response is not None:
                return response.scene
        return None

    def _variable_count(self):
        """The number of variables of the robot; 0 if no node reports it."""
        for node in self._nodes if self._variables == 0 else []:
            report = node.call(*self._ask_report)
            if report is not None and report.success:
                self._variables = int(dict(zip(report.names, report.values)).get("variables", 0))
                break
        return self._variables

    def _split(self, request, scene):
        """The parts of a request, all with the same revision and columns for all variables; or the whole request."""
        whole = copy.copy(request)
        whole.scene_revision = request.scene_revision or scene.scene_revision
        width = len(request.joint_names)
        count, rest = divmod(len(request.positions), width) if width else (0, 0)
        if request.named_state or count == 0 or rest or request.scene_diff != self._no_change:
            return [whole]
        joints = scene.robot_state.joint_state
        missing = {name: value for name, value in zip(joints.name, joints.position) if name not in request.joint_names}
        if len(set(request.joint_names)) + len(missing) != self._variable_count():
            return [whole]
        even = max(LEAST_PART, -(-count // (PARTS_PER_NODE * len(self._nodes))))
        rows = count if count <= UNSPLIT_STATES else min(even, self._part_states)
        parts = []
        for first in range(0, count, rows):
            part = copy.copy(whole)
            part.positions = request.positions[first * width:(first + rows) * width]
            if missing:
                part.joint_names = [*request.joint_names, *missing]
                given = part.positions
                part.positions = [value for row in range(0, len(given), width)
                                  for value in (*given[row:row + width], *missing.values())]
            parts.append(part)
        return parts

    def _serve(self, node, work, failures, until):
        """Sends parts to one node until all are answered or the node fails."""
        while True:
            part = work.take()
            if part is None:
                return
            request = work.parts[part]
            response = node.call("check_states", self._check_states, request)
            outcome = _outcome(response, request.scene_revision)
            if outcome == ANSWERED:
                work.answer(part, response)
                continue
            work.give_back(part)
            if outcome != BUSY or time.monotonic() > until:
                status, text = self._unavailable, "the node does not answer"
                if response is not None:
                    status = self._unknown_revision if outcome == OTHER_SCENES else response.status
                    text = response.message
                failures.add(outcome, status, f"{node.name}: {text}")
                return
            time.sleep(PAUSE)

    def _serve_all(self, work, failures, until):
        self._next = (self._next + 1) % len(self._nodes)
        nodes = self._nodes[self._next:] + self._nodes[:self._next]
        if len(work.parts) == 1:
            for node in nodes:
                if work.answered() == 0:
                    self._serve(node, work, failures, until)
            return
        threads = [threading.Thread(target=self._serve, args=(node, work, failures, until)) for node in nodes]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()


def _joined(answers):
    """The answer to the whole request, from the answers to its parts."""
    if len(answers) == 1:
        return answers[0]
    whole = copy.copy(answers[0])
    first = 0
    messages = []
    contacts = []
    for answer in answers:
        if answer.message and answer.message not in [text for _, text in messages]:
            messages.append((first, answer.message))
        for contact in answer.contacts:
            contact.state += first
            contacts.append(contact)
        first += len(answer.valid)
    # Warnings that name a state count the states of their part.
    whole.message = "; ".join(text if state == 0 else f"from state {state} on: {text}" for state, text in messages)
    whole.contacts = contacts
    whole.valid = b"".join(bytes(answer.valid) for answer in answers)
    for name in ("body_1", "body_2", "clearance_world", "clearance_self", "nearest_world", "nearest_self"):
        setattr(whole, name, [item for answer in answers for item in getattr(answer, name)])
    whole.seconds = sum(answer.seconds for answer in answers)
    return whole
