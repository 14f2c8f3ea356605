// ready_without_a_transfer: Without a transfer the subordinate is ready, and there is no error.
// error_has_two_cycles: An error takes two cycles, the first of them not ready.
    // A master within the rules: `hready` is the answer of whose data phase it is, or HIGH where this subordinate is alone.
    // The transfer is the data phase, with what its address phase said.
    reg p_on = 0, p_answer = 0, p_error = 0, p_held = 0, p_writes = 0, p_refused = 0;
    reg [10:0] p_asked = 0;
    reg [31:0] f_data = 0;
    wire f_start = hsel & htrans[1] & hready & hreadyout;
    wire t_on = p_held;
    wire [10:0] t_address = p_asked;
    wire t_refused = p_refused;
    wire t_write = p_writes;
    wire [31:0] t_word = hwdata, p_word = hwdata;
    wire t_answer = t_on & hreadyout;
    wire t_error = t_answer & hresp;
    wire [31:0] t_read = hrdata;
    wire t_left = 1'b0;
    always @(posedge clock) begin
        p_on <= t_on & !t_answer;
        p_held <= f_start | (t_on & !t_answer);
        p_answer <= t_answer;
        p_error <= hresp & !hreadyout;
        f_data <= hwdata;
        if (f_start) begin
            p_asked <= haddr[12:2];
            p_writes <= hwrite;
            p_refused <= haddr[1:0] != 0 || hsize != 2;
        end
    end
    always @* begin
        if (t_answer) assume (hready);
        if (p_on) assume (hwdata == f_data);
        ready_without_a_transfer: assert (t_on || (hreadyout && !hresp));
        error_has_two_cycles: assert (t_error == p_error);
    end
