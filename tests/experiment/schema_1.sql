-- The answers of an experiment. Rows are added and never changed, but for times and states of
-- sessions; only a withdrawal deletes. Times are UTC, as 2026-11-30T21:00:00.000Z.

CREATE TABLE setting (            -- the secret that keys hashes of identifiers
    name    TEXT PRIMARY KEY,
    value   TEXT NOT NULL
) STRICT;

CREATE TABLE version (            -- design, texts and stimuli lie in versions/HASH
    version     TEXT PRIMARY KEY, -- SHA-256 over all of them
    design      TEXT NOT NULL,    -- the design file as it was
    frozen_utc  TEXT              -- of its first invitation; null for tests and simulations
) STRICT;

CREATE TABLE observer (
    observer       INTEGER PRIMARY KEY,
    kind           TEXT NOT NULL CHECK (kind IN ('real', 'test', 'simulated')),
    site_hash      TEXT UNIQUE,   -- keyed hash of the identifier of a recruiting site
    "group"        TEXT,          -- null until the first session
    place          INTEGER,       -- place in the group, for counterbalancing
    withdrawn_utc  TEXT
) STRICT;
CREATE INDEX observer_group ON observer ("group", kind);

CREATE TABLE link (               -- keys are stored as hashes
    hash         TEXT PRIMARY KEY,
    kind         TEXT NOT NULL CHECK (kind IN ('personal', 'open', 'preview', 'lab')),
    observer     INTEGER REFERENCES observer,
    created_utc  TEXT NOT NULL
) STRICT;

CREATE TABLE session (
    session       INTEGER PRIMARY KEY,
    observer      INTEGER NOT NULL REFERENCES observer,
    number        INTEGER NOT NULL,                 -- from 1
    version       TEXT NOT NULL REFERENCES version,
    language      TEXT NOT NULL,
    consent_hash  TEXT NOT NULL,                    -- of the text that was agreed to
    consent_utc   TEXT NOT NULL,
    trials        TEXT NOT NULL,                    -- JSON: what is shown, in order
    ended_utc     TEXT,
    outcome       TEXT CHECK (outcome IN ('finished', 'stopped')),
    UNIQUE (observer, number)
) STRICT;

CREATE TABLE presence (           -- apart from sessions, whose rows are large
    session   INTEGER PRIMARY KEY REFERENCES session,
    seen_utc  TEXT NOT NULL                         -- of the last request
) STRICT;

CREATE TABLE answer (             -- all that pages report: trials begun and answered, screen, events
    answer        TEXT PRIMARY KEY,                 -- made by the page, once
    session       INTEGER NOT NULL REFERENCES session,
    kind          TEXT NOT NULL,
    trial         INTEGER,
    attempt       INTEGER,
    content       TEXT NOT NULL,                    -- JSON, without the times of frames
    received_utc  TEXT NOT NULL,
    via           TEXT NOT NULL CHECK (via IN ('page', 'rescue', 'simulation')),
    frame_times   TEXT                              -- JSON: ms from the first frame to each
) STRICT;
CREATE INDEX answer_session ON answer (session, trial);

CREATE TABLE refused (            -- what could not be taken, for the lab
    refused       INTEGER PRIMARY KEY,
    answer        TEXT NOT NULL,
    session       INTEGER NOT NULL REFERENCES session,
    reason        TEXT NOT NULL,
    content       TEXT NOT NULL,
    received_utc  TEXT NOT NULL,
    UNIQUE (answer, content)
) STRICT;

CREATE TABLE raw_identifier (     -- only where the design asks for it; never exported
    observer    INTEGER PRIMARY KEY REFERENCES observer,
    identifier  TEXT NOT NULL
) STRICT;

CREATE TABLE record (             -- withdrawals and the like: when, and nothing of whom
    record    INTEGER PRIMARY KEY,
    time_utc  TEXT NOT NULL,
    what      TEXT NOT NULL
) STRICT;
