    reg p_held = 0, p_on = 0, p_answer = 0, p_writes = 0, p_refused = 0;
    reg [10:0] p_asked = 0;
    reg [31:0] p_word = 0;
    // The bank has begun what this transfer asks for; the last byte of it; the bytes that it gave.
    reg f_done = 0;
    reg [1:0] f_lanes = 0;
    reg [31:0] f_word = 0;
    reg [5:0] f_waits = 0;
